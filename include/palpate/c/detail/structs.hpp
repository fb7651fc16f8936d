// Structs of the C interface: their sizes and versions, handles, and strings.
#pragma once

#include <palpate/c/detail/last_error.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <span>
#include <string>
#include <type_traits>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// Size of a struct in the first version of the interface: an older one does not exist. Before a field is appended,
/// specialise it with the size before.
template <class T>
inline constexpr std::uint32_t first_size = static_cast<std::uint32_t>(sizeof(T));

/// Whether a struct has a known version and a possible size.
template <class T>
bool is_known(const T& given) noexcept {
  static_assert(std::is_trivially_copyable_v<T> && std::is_standard_layout_v<T>);
  return given.interface_version == PALPATE_C_VERSION && given.struct_size >= first_size<T>;
}

/// Reads a struct of the caller, which may be shorter (an older program: zeros follow) or longer (a newer program: what
/// this library does not know must be zero).
template <class T>
T read_struct(const T* given, const char* name) {
  if (given == nullptr) refuse(std::string(name) + " is null");
  if (!is_known(*given))
    refuse(std::string(name) + " has size " + std::to_string(given->struct_size) + " and version " +
               std::to_string(given->interface_version) + "; expected " + std::to_string(sizeof(T)) + " and " +
               std::to_string(PALPATE_C_VERSION),
           "Prepare it with PALPATE_INIT");
  const auto* bytes = reinterpret_cast<const unsigned char*>(given);
  if (given->struct_size > sizeof(T) &&
      std::any_of(bytes + sizeof(T), bytes + given->struct_size, [](unsigned char byte) { return byte != 0; }))
    refuse(std::string(name) + " uses fields that this version of the library does not have",
           "Install a newer library, or leave the new fields zero");
  T read{};
  std::memcpy(&read, given, std::min<std::size_t>(given->struct_size, sizeof(T)));
  return read;
}

/// Fills a struct of the caller, as far as it reaches. False for an unknown size or version.
template <class T>
bool write_struct(T* out, T& value) noexcept {
  if (!is_known(*out)) return false;
  value.struct_size = out->struct_size;
  value.interface_version = out->interface_version;
  std::memcpy(out, &value, std::min<std::size_t>(out->struct_size, sizeof(T)));
  return true;
}

/// First member of what a handle points to: a handle of another kind is refused.
struct HandleTag {
  std::uint32_t value;
};

/// The object of a handle.
template <class Handle>
Handle& object(Handle* handle, const char* name) {
  if (handle == nullptr) refuse(std::string(name) + " is null", "Create it first, and check what that call returned");
  if (handle->tag.value != std::remove_const_t<Handle>::kind)
    refuse(std::string(name) + " is a handle of another kind");
  return *handle;
}

/// The target of a pointer to a result.
template <class T>
T& target(T* pointer, const char* name) {
  if (pointer == nullptr) refuse(std::string(name) + " is null");
  return *pointer;
}

/// `count` numbers of the caller.
template <class T>
std::span<T> numbers(T* pointer, std::size_t count, const char* name) {
  if (pointer == nullptr && count > 0) refuse(std::string(name) + " is null");
  return {pointer, count};
}

inline std::string text(const char* given, const char* name) {
  if (given == nullptr) refuse(std::string(name) + " is null");
  return given;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
