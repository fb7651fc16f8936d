// Bulk transfer of arrays to and from a binary file, with a hash of the transferred bytes.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/content_hash.hpp>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <memory>
#include <span>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(std::numeric_limits<double>::is_iec559 && std::numeric_limits<float>::is_iec559,
              "binary files contain IEEE 754 numbers");

namespace detail {

struct FileClose {
  void operator()(std::FILE* file) const noexcept { std::fclose(file); }
};
using File = std::unique_ptr<std::FILE, FileClose>;

/// The operating system's message for an errno value.
std::string system_message(int error);

}  // namespace detail

/// Writes values in their memory representation. After the first failure nothing more is written.
class BinaryWriter {
 public:
  explicit BinaryWriter(std::FILE* file) : file_(file) {}

  template <HashableBytes T>
  void value(const T& v) noexcept {
    bytes(&v, sizeof v);
  }
  /// The number of entries, then the entries.
  template <HashableBytes T>
  void array(std::span<const T> values) noexcept {
    value(static_cast<std::uint64_t>(values.size()));
    bytes(values.data(), values.size_bytes());
  }

  bool good() const noexcept { return error_ == no_error; }
  /// errno of the failure.
  int error() const noexcept { return error_; }
  std::uint64_t digest() const noexcept { return hash_.digest(); }
  std::uint64_t written() const noexcept { return written_; }

 private:
  static constexpr int no_error = -1;

  void bytes(const void* data, std::size_t size) noexcept;

  std::FILE* file_;
  ContentHash hash_;
  std::uint64_t written_ = 0;
  int error_ = no_error;
};

/// Why a reader stopped.
enum class ReadFailure : std::uint8_t {
  none,
  ended,    ///< the file is too short
  damaged,  ///< a count differs from the expected one
  unfit,    ///< the numbers belong to another structure
};

/// Reads the output of a BinaryWriter into arrays whose sizes the caller knows: no allocation size is ever taken from a
/// file. After the first failure nothing more is read; the values read are valid only if the digest matches.
class BinaryReader {
 public:
  explicit BinaryReader(std::FILE* file) : file_(file) {}

  template <HashableBytes T>
  bool value(T& v) noexcept {
    return bytes(&v, sizeof v);
  }
  /// Reads a value that must equal `wanted`; if it does not, sets the failure `otherwise`.
  template <HashableBytes T>
  bool expect(const T& wanted, ReadFailure otherwise) noexcept {
    T found{};
    if (!value(found)) return false;
    if (std::memcmp(&found, &wanted, sizeof wanted) != 0) failure_ = otherwise;
    return good();
  }
  /// Fills an array; its length in the file must be the same.
  template <HashableBytes T>
  bool array(std::span<T> values) noexcept {
    return expect(static_cast<std::uint64_t>(values.size()), ReadFailure::damaged) &&
           bytes(values.data(), values.size_bytes());
  }

  bool good() const noexcept { return failure_ == ReadFailure::none; }
  ReadFailure failure() const noexcept { return failure_; }
  std::uint64_t digest() const noexcept { return hash_.digest(); }
  std::uint64_t bytes_read() const noexcept { return read_; }

 private:
  bool bytes(void* data, std::size_t size) noexcept;

  std::FILE* file_;
  ContentHash hash_;
  std::uint64_t read_ = 0;
  ReadFailure failure_ = ReadFailure::none;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/core/detail/binary_io.ipp>
#endif
