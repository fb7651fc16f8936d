// Bulk transfer of arrays and matrices to and from a binary file, with a hash of the transferred bytes.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/content_hash.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
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
inline std::string system_message(int error) {
  return error == 0 ? std::string("an unknown error") : std::generic_category().message(error);
}

}  // namespace detail

/// Writes values in their memory representation. After the first failure nothing more is written.
class BinaryWriter {
 public:
  explicit BinaryWriter(std::FILE* file) : file_(file) {}

  template <detail::HashableBytes T>
  void value(const T& v) noexcept {
    bytes(&v, sizeof v);
  }
  /// The number of entries, then the entries.
  template <detail::HashableBytes T>
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
  detail::ContentHash hash_;
  std::uint64_t written_ = 0;
  int error_ = no_error;
};

namespace detail {

/// Why a reader stopped.
enum class ReadFailure : std::uint8_t {
  none,
  ended,    ///< the file is too short
  damaged,  ///< a count differs from the expected one
  unfit,    ///< the numbers belong to another structure
};

}  // namespace detail

/// Reads the output of a BinaryWriter into arrays whose sizes the caller knows: no allocation size is ever taken from a
/// file. After the first failure nothing more is read; the values read are valid only if the digest matches.
class BinaryReader {
 public:
  explicit BinaryReader(std::FILE* file) : file_(file) {}

  template <detail::HashableBytes T>
  bool value(T& v) noexcept {
    return bytes(&v, sizeof v);
  }
  /// Reads a value that must equal `wanted`; if it does not, sets the failure `otherwise`.
  template <detail::HashableBytes T>
  bool expect(const T& wanted, detail::ReadFailure otherwise) noexcept {
    T found{};
    if (!value(found)) return false;
    if (std::memcmp(&found, &wanted, sizeof wanted) != 0) failure_ = otherwise;
    return good();
  }
  /// Fills an array; its length in the file must be the same.
  template <detail::HashableBytes T>
  bool array(std::span<T> values) noexcept {
    return expect(static_cast<std::uint64_t>(values.size()), detail::ReadFailure::damaged) &&
           bytes(values.data(), values.size_bytes());
  }

  bool good() const noexcept { return failure_ == detail::ReadFailure::none; }
  detail::ReadFailure failure() const noexcept { return failure_; }
  std::uint64_t digest() const noexcept { return hash_.digest(); }
  std::uint64_t bytes_read() const noexcept { return read_; }

 private:
  bool bytes(void* data, std::size_t size) noexcept;

  std::FILE* file_;
  detail::ContentHash hash_;
  std::uint64_t read_ = 0;
  detail::ReadFailure failure_ = detail::ReadFailure::none;
};

namespace detail {

/// Writes all entries by columns; a null pointer is written as an empty matrix.
template <class Matrix>
void write_dense(BinaryWriter& out, const Matrix* matrix) {
  using Scalar = typename Matrix::Scalar;
  if (matrix == nullptr) return out.array(std::span<const Scalar>());
  out.array(std::span<const Scalar>(matrix->data(), static_cast<std::size_t>(matrix->size())));
}

/// Reads a matrix that must be size x size in the file. Throws too_large before it allocates.
template <class Scalar>
Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> read_dense(BinaryReader& in, Index size,
                                                                 const SetupLimits& limits) {
  limits.require_memory(static_cast<double>(size) * static_cast<double>(size) * sizeof(Scalar), "a stored matrix");
  Eigen::Matrix<Scalar, Eigen::Dynamic, Eigen::Dynamic> matrix;
  if (!in.good()) return matrix;
  matrix.resize(size, size);
  in.array(std::span<Scalar>(matrix.data(), static_cast<std::size_t>(matrix.size())));
  return matrix;
}

/// Bytes per step of hashing and file access, small enough to stay in the cache between the two. Part of the file
/// format.
inline constexpr std::size_t binary_chunk = std::size_t{1} << 18;

}  // namespace detail

inline void BinaryWriter::bytes(const void* data, std::size_t size) noexcept {
  const auto* from = static_cast<const char*>(data);
  for (std::size_t n = 0; size > 0 && good(); from += n, size -= n) {
    n = std::min(size, detail::binary_chunk);
    hash_.add(std::span<const char>(from, n));
    errno = 0;
    if (std::fwrite(from, 1, n, file_) != n) error_ = errno;
    written_ += n;
  }
}

inline bool BinaryReader::bytes(void* data, std::size_t size) noexcept {
  auto* to = static_cast<char*>(data);
  for (std::size_t n = 0; size > 0 && good(); to += n, size -= n) {
    n = std::min(size, detail::binary_chunk);
    if (std::fread(to, 1, n, file_) != n) {
      failure_ = detail::ReadFailure::ended;
      break;
    }
    hash_.add(std::span<const char>(to, n));
    read_ += n;
  }
  return good();
}

}}  // namespace palpate
