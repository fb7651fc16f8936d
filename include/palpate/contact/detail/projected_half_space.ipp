// Definitions of projected_half_space.hpp.
#pragma once

#include <palpate/contact/detail/projected_half_space.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ProjectedHalfSpace::ProjectedHalfSpace(std::vector<HalfSpacePoint> vertices,
                                                      std::vector<HalfSpaceMarks> marks, Blocks blocks) noexcept
    : vertices_(std::move(vertices)), marks_(std::move(marks)), blocks_(std::move(blocks)) {}

PALPATE_INLINE std::span<const int> ProjectedHalfSpace::columns(int row) const noexcept {
  const auto r = static_cast<std::size_t>(row);
  return {blocks_.column.data() + blocks_.row_start[r],
          static_cast<std::size_t>(blocks_.row_start[r + 1] - blocks_.row_start[r])};
}

PALPATE_INLINE std::span<const Matrix3> ProjectedHalfSpace::blocks(int row) const noexcept {
  return {blocks_.value.data() + blocks_.row_start[static_cast<std::size_t>(row)], columns(row).size()};
}

PALPATE_INLINE Matrix3 ProjectedHalfSpace::operator()(int i, int j) const noexcept {
  const std::span<const int> row = columns(std::max(i, j));
  const auto at = std::ranges::lower_bound(row, std::min(i, j));
  if (at == row.end() || *at != std::min(i, j)) return Matrix3::Zero();
  const Matrix3& block = blocks(std::max(i, j))[static_cast<std::size_t>(at - row.begin())];
  return i >= j ? block : Matrix3(block.transpose());
}

PALPATE_INLINE std::size_t ProjectedHalfSpace::bytes() const noexcept {
  return vertices_.size() * (sizeof(HalfSpacePoint) + sizeof(HalfSpaceMarks)) +
         blocks_.row_start.size() * sizeof(Index) + blocks_.column.size() * (sizeof(int) + sizeof(Matrix3));
}

}}  // namespace palpate
