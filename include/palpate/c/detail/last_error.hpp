// Errors of the C interface: the last one of each thread, and the border that no exception crosses.
#pragma once

#include <palpate/c/palpate.h>
#include <palpate/core/setup_error.hpp>

#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// A call that makes no sense: PALPATE_INVALID_ARGUMENT.
struct InvalidArgument {
  std::string what, hint;
};

[[noreturn]] PALPATE_COLD void refuse(std::string what, std::string hint = {});

/// Stores an error of the calling thread and returns its kind. Allocates nothing.
PALPATE_COLD palpate_error store(palpate_error kind, const char* text, const char* hint = "") noexcept;
/// The same for the exception that is being handled.
PALPATE_COLD palpate_error store_exception() noexcept;
/// The last error of the calling thread.
const palpate_error_info& last_error() noexcept;

/// Calls f; an exception becomes an error of the calling thread.
template <class F>
palpate_error guarded(F&& f) noexcept {
  try {
    std::forward<F>(f)();
    return PALPATE_OK;
  } catch (...) {
    return store_exception();
  }
}

constexpr palpate_error error_of(SetupErrorKind kind) noexcept {
  return static_cast<palpate_error>(kind) + 1;
}
static_assert(error_of(SetupErrorKind::bad_argument) == PALPATE_BAD_ARGUMENT);
static_assert(error_of(SetupErrorKind::inverted_element) == PALPATE_INVERTED_ELEMENT);
static_assert(error_of(SetupErrorKind::unknown_group) == PALPATE_UNKNOWN_GROUP);
static_assert(error_of(SetupErrorKind::cancelled) == PALPATE_CANCELLED);
static_assert(error_of(SetupErrorKind::unsupported) == PALPATE_UNSUPPORTED);
static_assert(static_cast<int>(SetupIds::nodes) == PALPATE_IDS_NODES);
static_assert(static_cast<int>(SetupIds::elements) == PALPATE_IDS_ELEMENTS);

}}}  // namespace palpate::PALPATE_ABI::c_interface
