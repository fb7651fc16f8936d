// Definitions of big_array.hpp.
#pragma once

#include <palpate/core/platform.hpp>
#include <palpate/linear/detail/big_array.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE BigArray::BigArray(Index size) : size_(size) {
  constexpr std::size_t huge_page = std::size_t{1} << 21, line = 64;
  const std::size_t alignment = bytes() >= 2 * huge_page ? huge_page : line;
  data_ = {static_cast<double*>(::operator new (bytes(), std::align_val_t{alignment})), AlignedDelete{alignment}};
  if (alignment == huge_page) platform::prefer_huge_pages(data_.get(), bytes());
}

}}}  // namespace palpate::detail
