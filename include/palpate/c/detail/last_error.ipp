// Errors of the C interface, and its names and versions.
#pragma once

#include <palpate/c/detail/last_error.hpp>
#include <palpate/c/detail/structs.hpp>
#include <palpate/core/status.hpp>
#include <palpate/version.hpp>

#include <algorithm>
#include <cstring>
#include <exception>
#include <new>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

namespace {

thread_local palpate_error_info newest{};

/// Copies a text into a field of N bytes, cut off where it is longer, at the start of a UTF-8 character.
template <std::size_t N>
void copy(std::string_view text, char (&field)[N]) noexcept {
  std::size_t size = std::min(text.size(), N - 1);
  if (size < text.size())
    while (size > 0 && (static_cast<unsigned char>(text[size]) & 0xc0u) == 0x80u) --size;
  std::memcpy(field, text.data(), size);
  field[size] = '\0';
}

palpate_error keep(palpate_error kind, std::string_view text, std::string_view hint) noexcept {
  newest = {};
  newest.kind = kind;
  copy(text, newest.text);
  copy(hint, newest.hint);
  return kind;
}

palpate_error keep(const SetupProblem& problem) noexcept {
  keep(error_of(problem.kind), problem.what, problem.hint);
  newest.ids_of = static_cast<std::int32_t>(problem.ids_of);
  newest.count = problem.count;
  newest.id_count = static_cast<std::int32_t>(std::min<std::size_t>(problem.ids.size(), PALPATE_MOST_ERROR_IDS));
  std::copy_n(problem.ids.begin(), newest.id_count, newest.ids);
  newest.value = problem.value;
  newest.threshold = problem.threshold;
  return newest.kind;
}

}  // namespace

PALPATE_INLINE void refuse(std::string what, std::string hint) {
  throw InvalidArgument{std::move(what), std::move(hint)};
}

PALPATE_INLINE palpate_error store(palpate_error kind, const char* text, const char* hint) noexcept {
  return keep(kind, text, hint);
}

PALPATE_INLINE palpate_error store_exception() noexcept {
  try {
    throw;
  } catch (const SetupError& error) {
    return keep(error.problem());
  } catch (const InvalidArgument& error) {
    return keep(PALPATE_INVALID_ARGUMENT, error.what, error.hint);
  } catch (const std::bad_alloc&) {
    return keep(PALPATE_OUT_OF_MEMORY, "there is not enough memory", "Use a smaller mesh, or touch a smaller part");
  } catch (const std::exception& error) {
    return keep(PALPATE_INTERNAL_ERROR, error.what(), "");
  } catch (...) {
    return keep(PALPATE_INTERNAL_ERROR, "an exception of an unknown type", "");
  }
}

PALPATE_INLINE const palpate_error_info& last_error() noexcept {
  return newest;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface

extern "C" {

palpate_error palpate_last_error(palpate_error_info* info) {
  using namespace palpate::c_interface;
  if (info == nullptr) return PALPATE_INVALID_ARGUMENT;
  palpate_error_info copied = last_error();  // a refusal of `info` itself must not replace it
  if (!write_struct(info, copied)) return PALPATE_INVALID_ARGUMENT;
  return PALPATE_OK;
}

const char* palpate_error_name(palpate_error kind) {
  using palpate::SetupErrorKind;
  if (kind == PALPATE_OK) return "ok";
  if (kind == PALPATE_OUT_OF_MEMORY) return "out_of_memory";
  if (kind == PALPATE_INVALID_ARGUMENT) return "invalid_argument";
  if (kind == PALPATE_INTERNAL_ERROR) return "internal_error";
  if (kind < 1 || kind > PALPATE_UNSUPPORTED) return "unknown";
  return to_string(static_cast<SetupErrorKind>(kind - 1)).data();
}

const char* palpate_status_name(int32_t bit) {
  return bit < 0 || bit >= palpate::status_flag_count ? nullptr : palpate::status_flag_name(bit).data();
}

int32_t palpate_status_count(void) {
  return palpate::status_flag_count;
}

uint32_t palpate_interface_version(void) {
  return PALPATE_C_VERSION;
}

#define PALPATE_TEXT_OF(number) #number
#define PALPATE_TEXT(number) PALPATE_TEXT_OF(number)
const char* palpate_version(void) {
  return PALPATE_TEXT(PALPATE_VERSION_MAJOR) "." PALPATE_TEXT(PALPATE_VERSION_MINOR) "." PALPATE_TEXT(
      PALPATE_VERSION_PATCH);
}
#undef PALPATE_TEXT
#undef PALPATE_TEXT_OF

}  // extern "C"
