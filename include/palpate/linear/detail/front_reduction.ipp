// Definitions of front_reduction.hpp.
#pragma once

#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/linear/detail/front_block_sweeps.hpp>
#include <palpate/linear/detail/front_reduction.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Some rows of a matrix, in the given order.
inline MatrixX rows_of(const MatrixX& m, const std::vector<Index>& rows) {
  const auto count = static_cast<Index>(rows.size());
  MatrixX taken(count, m.cols());
  for (Index j = 0; j < m.cols(); ++j)
    for (Index i = 0; i < count; ++i)
      taken.data()[i + j * count] = m.data()[rows[static_cast<std::size_t>(i)] + j * m.rows()];
  return taken;
}

/// The fronts above some dofs, among the first `fronts` ones, children first.
inline std::vector<Index> fronts_above(const FrontTree& tree, Index fronts, std::span<const Index> dofs) {
  std::vector<Index> above;
  for (const Index dof : dofs)
    for (Index f = tree.front_of_dof[dof]; f >= 0 && f < fronts; f = tree.fronts[f].parent) above.push_back(f);
  std::sort(above.begin(), above.end());
  above.erase(std::unique(above.begin(), above.end()), above.end());
  return above;
}

PALPATE_INLINE ReducedUnits reduce_units(const FrontTree& tree, const double* factor, Index fronts,
                                         std::span<const Index> dofs, std::span<const Index> kept) {
  FrontBlockSweeps sweeps(tree, factor, static_cast<Index>(dofs.size()));
  const std::vector<Index> all = fronts_above(tree, fronts, dofs);
  ReducedUnits out;
  for (const Index f : all)
    for (Index i = 0; i < tree.fronts[f].pivots; ++i) out.places.push_back(tree.fronts[f].first + i);
  const auto rows = static_cast<Index>(out.places.size()), kept_rows = static_cast<Index>(kept.size());
  out.values.resize(rows, static_cast<Index>(dofs.size()));
  out.kept_load.resize(kept_rows, static_cast<Index>(dofs.size()));
  const auto clear = [&](Index f) { sweeps.clear(tree.fronts[f].first, tree.fronts[f].pivots); };
  const auto width = static_cast<std::size_t>(sweeps.width());
  for (std::size_t begin = 0; begin < dofs.size(); begin += width) {
    const auto part = dofs.subspan(begin, std::min(dofs.size() - begin, width));
    const auto first = static_cast<Index>(begin), count = static_cast<Index>(part.size());
    for (const Index f : all) clear(f);
    if (fronts < tree.fronts.size()) clear(fronts);
    for (Index k = 0; k < count; ++k) sweeps.row(tree.place_of_dof[part[static_cast<std::size_t>(k)]])[k] = 1.0;
    for (const Index f : fronts_above(tree, fronts, part)) sweeps.forward(tree.fronts[f]);
    for (Index i = 0; i < rows; ++i) {
      const double* const row = sweeps.row(out.places[static_cast<std::size_t>(i)]);
      for (Index k = 0; k < count; ++k) out.values.data()[i + (first + k) * rows] = row[k];
    }
    for (Index i = 0; i < kept_rows; ++i) {
      const double* const row = sweeps.row(tree.place_of_dof[kept[static_cast<std::size_t>(i)]]);
      for (Index k = 0; k < count; ++k) out.kept_load.data()[i + (first + k) * kept_rows] = row[k];
    }
  }
  return out;
}

PALPATE_INLINE MatrixX ReducedUnits::products(const ReducedUnits& other) const {
  std::vector<Index> mine, others;
  for (std::size_t i = 0, j = 0; i < places.size() && j < other.places.size();)
    if (places[i] == other.places[j]) {
      mine.push_back(static_cast<Index>(i++));
      others.push_back(static_cast<Index>(j++));
    } else {
      ++(places[i] < other.places[j] ? i : j);
    }
  return transposed_product(rows_of(values, mine), rows_of(other.values, others));
}

}}}  // namespace palpate::detail
