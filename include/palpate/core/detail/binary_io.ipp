// Definitions of binary_io.hpp.
#pragma once

#include <palpate/core/detail/binary_io.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE std::string system_message(int error) {
  return error == 0 ? std::string("an unknown error") : std::generic_category().message(error);
}

/// Bytes per step of hashing and file access, small enough to stay in the cache between the two. Part of the file
/// format.
inline constexpr std::size_t binary_chunk = std::size_t{1} << 18;

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void BinaryWriter::bytes(const void* data, std::size_t size) noexcept {
  const auto* from = static_cast<const char*>(data);
  for (std::size_t n = 0; size > 0 && good(); from += n, size -= n) {
    n = std::min(size, detail::binary_chunk);
    hash_.add(std::span<const char>(from, n));
    errno = 0;
    if (std::fwrite(from, 1, n, file_) != n) error_ = errno;
    written_ += n;
  }
}

PALPATE_INLINE bool BinaryReader::bytes(void* data, std::size_t size) noexcept {
  auto* to = static_cast<char*>(data);
  for (std::size_t n = 0; size > 0 && good(); to += n, size -= n) {
    n = std::min(size, detail::binary_chunk);
    if (std::fread(to, 1, n, file_) != n) {
      failure_ = ReadFailure::ended;
      break;
    }
    hash_.add(std::span<const char>(to, n));
    read_ += n;
  }
  return good();
}

}}  // namespace palpate
