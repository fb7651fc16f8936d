// Unit loads on a few dofs, taken half the way through a multifrontal factor.
#pragma once

#include <palpate/linear/front_block_substitution.hpp>
#include <palpate/linear/front_tree.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// L^-1 e of unit loads e on some dofs of an interior factor, where it is not zero, and what they condense to on the
/// kept dofs. Entries of the inverse follow without going back: with F the condensed loads and C the compliance of the
/// kept dofs, G_ij = y_i . y_j + f_i . C f_j, and C f_j on the kept dofs.
struct ReducedUnits {
  std::vector<Index> places;  ///< of the rows, in the elimination order, ascending
  MatrixX values;             ///< places x loads
  MatrixX kept_load;          ///< kept x loads

  Index size() const noexcept { return values.cols(); }
  /// y_i . y_j for all pairs.
  MatrixX products(const ReducedUnits& other) const {
    std::vector<std::pair<Index, Index>> same;
    for (std::size_t i = 0, j = 0; i < places.size() && j < other.places.size();)
      if (places[i] == other.places[j])
        same.push_back({static_cast<Index>(i++), static_cast<Index>(j++)});
      else
        ++(places[i] < other.places[j] ? i : j);
    const auto rows = static_cast<Index>(same.size());
    MatrixX a(rows, size()), b(rows, other.size());
    for (Index k = 0; k < rows; ++k) {
      a.row(k) = values.row(same[static_cast<std::size_t>(k)].first);
      b.row(k) = other.values.row(same[static_cast<std::size_t>(k)].second);
    }
    return a.transpose() * b;
  }
};

namespace detail {

/// Forward substitution of unit loads, a few packets at a time, through the fronts above them only.
template <int Packets>
class UnitReduction {
 public:
  UnitReduction(const FrontTree& tree, const double* factor, Index fronts)
      : tree_(tree), factor_(factor), fronts_(fronts) {
    values_.resize(width, tree.place_of_dof.size());
    local_.resize(width, LowerPanels::padded(tree.largest_front) + LowerPanels::alignment);
  }

  /// Loads on `dofs`, none of them kept; `kept` are the dofs of the front that was left out. Allocates.
  ReducedUnits reduce(std::span<const Index> dofs, std::span<const Index> kept) {
    ReducedUnits out;
    const std::vector<Index> all = path(dofs);
    for (const Index f : all)
      for (Index i = 0; i < tree_.fronts[f].pivots; ++i) out.places.push_back(tree_.fronts[f].first + i);
    out.values.resize(static_cast<Index>(out.places.size()), static_cast<Index>(dofs.size()));
    out.kept_load.resize(static_cast<Index>(kept.size()), static_cast<Index>(dofs.size()));
    for (std::size_t begin = 0; begin < dofs.size(); begin += static_cast<std::size_t>(width)) {
      const auto part = dofs.subspan(begin, std::min(dofs.size() - begin, static_cast<std::size_t>(width)));
      const auto first = static_cast<Index>(begin), count = static_cast<Index>(part.size());
      for (const Index f : all) clear(tree_.fronts[f]);
      if (fronts_ < tree_.fronts.size()) clear(tree_.fronts[fronts_]);
      for (Index k = 0; k < count; ++k) values_(k, tree_.place_of_dof[part[static_cast<std::size_t>(k)]]) = 1.0;
      for (const Index f : path(part)) forward(tree_.fronts[f]);
      for (std::size_t i = 0; i < out.places.size(); ++i)
        out.values.row(static_cast<Index>(i)).segment(first, count) =
            values_.col(out.places[i]).head(count).transpose();
      for (std::size_t i = 0; i < kept.size(); ++i)
        out.kept_load.row(static_cast<Index>(i)).segment(first, count) =
            values_.col(tree_.place_of_dof[kept[i]]).head(count).transpose();
    }
    return out;
  }

 private:
  static constexpr Index width = FrontBlock<Packets>::width;

  /// Fronts above some dofs, children first, the one that was left out excepted.
  std::vector<Index> path(std::span<const Index> dofs) const {
    std::vector<Index> fronts;
    for (const Index dof : dofs)
      for (Index f = tree_.front_of_dof[dof]; f >= 0 && f < fronts_; f = tree_.fronts[f].parent) fronts.push_back(f);
    std::sort(fronts.begin(), fronts.end());
    fronts.erase(std::unique(fronts.begin(), fronts.end()), fronts.end());
    return fronts;
  }
  void clear(const Front& f) { values_.middleCols(f.first, f.pivots).setZero(); }
  void forward(const Front& f) {
    const LowerPanels shape = f.panels();
    local_.leftCols(f.pivots) = values_.middleCols(f.first, f.pivots);
    local_.middleCols(f.pivots, shape.height - f.pivots).setZero();
    FrontBlock<Packets>::forward(factor_ + f.factor, shape, local_.data());
    values_.middleCols(f.first, f.pivots) = local_.leftCols(f.pivots);
    Index from = f.pivots;
    for (Index r = f.run_begin; r < f.run_end; from += tree_.runs[r++].count)
      values_.middleCols(tree_.runs[r].first, tree_.runs[r].count) += local_.middleCols(from, tree_.runs[r].count);
  }

  const FrontTree& tree_;
  const double* factor_;
  Index fronts_;
  Eigen::Matrix<double, width, Eigen::Dynamic> values_, local_;
};

}  // namespace detail

}}  // namespace palpate
