// Definitions of cut_view.hpp.
#pragma once

#include <palpate/cut/detail/cut_view.hpp>
#include <palpate/core/detail/lanes.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE bool erase_stretched(const std::vector<Vector3>& positions, double longest,
                                    std::vector<Triangle>& triangles, std::vector<Index>& elements) {
  std::size_t left = 0;
  for (std::size_t t = 0; t < triangles.size(); ++t) {
    const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(triangles[t][i])]; };
    if (!((at(0) - at(1)).norm() <= longest && (at(1) - at(2)).norm() <= longest && (at(2) - at(0)).norm() <= longest))
      continue;
    triangles[left] = triangles[t];
    if (!elements.empty()) elements[left] = elements[t];
    ++left;
  }
  const bool erased = left < triangles.size();
  triangles.resize(left);
  if (!elements.empty()) elements.resize(left);
  return erased;
}

PALPATE_INLINE Matrix3 CutView::compliance(int i, int j) const noexcept {
  const auto &a = dofs_of(i), &b = dofs_of(j);
  Matrix3 block;
  for (std::size_t c = 0; c < 3; ++c)
    for (std::size_t r = 0; r < 3; ++r)
      block(static_cast<Index>(r), static_cast<Index>(c)) = a[r] < 0 || b[c] < 0 ? 0.0 : (*step)(a[r], b[c]);
  return block;
}

PALPATE_INLINE void CutView::bound_by(const std::vector<double>& before) {
  const auto& places = contact->dofs;
  double longest = 0.0;
  for (const auto& p : places) longest = std::max(longest, std::sqrt(squares(step->z, p)));
  bound.assign(places.size(), 0.0);
  VectorX row(step->all);
  for (std::size_t v = 0; v < places.size(); ++v) {
    const bool known = v < before.size() && std::ranges::all_of(places[v], [&](Index p) { return p < step->old; });
    bound[v] = known ? before[v] + longest * std::sqrt(squares(step->y, places[v])) : exact_bound(v, row);
  }
  set_floor();
}

PALPATE_INLINE void CutView::bound_as(const std::vector<double>& before) {
  bound = before;
  set_floor();
}

PALPATE_INLINE void CutView::bound_exactly() {
  bound.assign(contact->dofs.size(), 0.0);
  VectorX row(step->all);
  for (std::size_t v = 0; v < bound.size(); ++v) bound[v] = exact_bound(v, row);
  set_floor();
}

PALPATE_INLINE const std::array<Index, 3>& CutView::dofs_of(int vertex) const noexcept {
  return contact->dofs[static_cast<std::size_t>(vertex)];
}

PALPATE_INLINE double CutView::squares(const MatrixX& columns, const std::array<Index, 3>& at) const noexcept {
  double sum = 0.0;
  for (const Index p : at)
    if (p >= 0 && p < columns.cols()) sum += columns.col(p).squaredNorm();
  return sum;
}

PALPATE_INLINE double CutView::exact_bound(std::size_t j, VectorX& row) const noexcept {
  row.setZero();
  for (const Index p : contact->dofs[j])
    if (p >= 0) step->add_squares(p, row);
  double largest = 0.0;
  for (const auto& at : contact->dofs) {
    double sum = 0.0;
    for (const Index p : at)
      if (p >= 0) sum += row[p];
    largest = std::max(largest, sum);
  }
  return std::sqrt(largest);
}

PALPATE_INLINE void CutView::set_floor() noexcept {
  double softest = 0.0, hardest = infinity;
  for (const double b : bound) {
    softest = std::max(softest, b);
    if (b > 0.0) hardest = std::min(hardest, b);
  }
  floor = softest > 0.0 ? std::min(1e-9 * softest, 1e-7 * hardest) : 1e-9;
}

}}}  // namespace palpate::detail
