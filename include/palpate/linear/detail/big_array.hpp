// Large uninitialised blocks of doubles.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/core/types.hpp>

#include <memory>
#include <new>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

struct AlignedDelete {
  std::size_t alignment = 64;
  void operator()(double* p) const noexcept { ::operator delete (p, std::align_val_t{alignment}); }
};

/// Uninitialised doubles, aligned for any packet. On Linux, large arrays request huge pages, so that a factorisation
/// causes fewer page faults while it fills them.
class BigArray {
 public:
  BigArray() = default;
  explicit BigArray(Index size);

  double* data() noexcept { return data_.get(); }
  const double* data() const noexcept { return data_.get(); }
  Index size() const noexcept { return size_; }
  std::size_t bytes() const noexcept { return static_cast<std::size_t>(size_) * sizeof(double); }

 private:
  std::unique_ptr<double, AlignedDelete> data_;
  Index size_ = 0;
};

inline BigArray::BigArray(Index size) : size_(size) {
  constexpr std::size_t huge_page = std::size_t{1} << 21, line = 64;
  const std::size_t alignment = bytes() >= 2 * huge_page ? huge_page : line;
  data_ = {static_cast<double*>(::operator new (bytes(), std::align_val_t{alignment})), AlignedDelete{alignment}};
  if (alignment == huge_page) platform::prefer_huge_pages(data_.get(), bytes());
}

}}}  // namespace palpate::detail
