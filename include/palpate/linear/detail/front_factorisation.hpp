// The numerical phase of a multifrontal factorisation (Duff and Reid 1983; Liu 1992).
#pragma once

#include <palpate/linear/detail/big_array.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/front_kernels.hpp>
#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/pivot_check.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Eliminates one front after the other into `factor`. Can be reused for other values on the same pattern.
class FrontFactorisation {
 public:
  FrontFactorisation(const CholeskyAnalysis& analysis, double* factor)
      : tree_(analysis.tree()),
        factor_(factor),
        workspace_(tree_.workspace_size + 64),
        packed_(analysis.pack_size()),
        node_of_dof_(analysis.node_of_dof()),
        local_(analysis.size(), 0),
        pivots_(analysis.size()),
        diagonal_(zeros(analysis.size())) {
    Index most = 0;
    for (Index f = 0; f < tree_.fronts.size(); ++f)
      most = std::max<Index>(most, tree_.fronts[f].run_end - tree_.fronts[f].run_begin);
    matched_.reserve(static_cast<std::size_t>(most));
  }

  /// Refers to the values of a matrix with the analysed pattern; they must stay valid until elimination is done.
  void take(const SparseLower& lower) noexcept {
    values_ = lower.valuePtr();
    for (Index j = 0; j < lower.cols(); ++j)
      for (Index p = lower.outerIndexPtr()[j]; p < lower.outerIndexPtr()[j + 1]; ++p)
        if (lower.innerIndexPtr()[p] == j) diagonal_[tree_.place_of_dof[j]] = values_[p];
  }

  /// Eliminates the first `count` fronts. Throws not_positive_definite or cancelled.
  void eliminate(Index count, double threshold, const SetupLimits& limits) {
    double done = 0.0, reported = 0.0;
    for (Index f = 0; f < count; ++f) {
      eliminate_front(tree_.fronts[f], threshold);
      done += tree_.fronts[f].flops();
      if (done - reported < 0.01 * tree_.flops) continue;
      reported = done;
      limits.advance("factorisation", done / tree_.flops);
    }
    const Index checked = count == 0 ? 0 : tree_.fronts[count - 1].first + tree_.fronts[count - 1].pivots;
    check_pivots(pivots_, diagonal_, tree_.place_of_dof, node_of_dof_, checked, threshold);
  }

  /// Eliminates all fronts; returns false when a pivot fails. No allocation.
  bool try_eliminate(double threshold) noexcept {
    for (Index f = 0; f < tree_.fronts.size(); ++f) {
      const Front& front = tree_.fronts[f];
      eliminate_front(front, threshold);
      for (Index i = front.first; i < front.first + front.pivots; ++i)
        if (!pivot_is_good(pivots_[i], diagonal_[i], threshold)) return false;
    }
    return true;
  }

  /// Returns the last front before its elimination: the Schur complement of the kept dofs in the given order. No front
  /// can be eliminated afterwards.
  MatrixX schur(const std::vector<Index>& kept) {
    const auto k = static_cast<Index>(kept.size());
    if (k == 0) return {};
    const Front& front = tree_.fronts.back();
    const LowerPanels shape = front.panels();
    BigArray columns(shape.size());
    assemble(front, columns.data());
    workspace_ = BigArray();
    MatrixX complement(k, k);
    double* const s = complement.data();
    for (Index j = 0; j < k; ++j)
      for (Index i = j; i < k; ++i) {
        const Index a = local_[tree_.place_of_dof[kept[static_cast<std::size_t>(i)]]];
        const Index b = local_[tree_.place_of_dof[kept[static_cast<std::size_t>(j)]]];
        s[i + j * k] = s[j + i * k] = columns.data()[shape.at(std::max(a, b), std::min(a, b))];
      }
    return complement;
  }

 private:
  void eliminate_front(const Front& front, double threshold) noexcept {
    const PivotSink sink{pivots_.data(), diagonal_.data(), threshold};
    double* const columns = factor_ + front.factor;
    assemble(front, columns);
    double* const update = workspace_.data() + front.update;
    factor_front(columns, front.pivots, front.rows, update, front.first, sink, packed_.data());
    add_children(
        front, [&](Index j) { return update + update_column(front, j); }, front.pivots, front.size());
  }

  /// Fills the pivot columns of a front before elimination with entries of the matrix and updates of the children.
  void assemble(const Front& front, double* columns) {
    const LowerPanels shape = front.panels();
    std::fill(columns, columns + shape.size(), 0.0);
    number_rows(front);
    for (NodeId e = front.first_entry; e >= 0; e = tree_.entries[e].next) {
      const EntryRun& run = tree_.entries[e];
      const double* value = values_ + run.source;
      if (run.count > 0) {
        double* to = columns + shape.at(local_[run.row], local_[run.column]);
        for (Index i = 0; i < run.count; ++i) to[i] += value[i];
      } else {
        for (Index i = 0; i < -run.count; ++i) columns[shape.at(local_[run.row], local_[run.column] + i)] += value[i];
      }
    }
    add_children(
        front, [&](Index j) { return columns + shape.at(0, j); }, 0, front.pivots);
  }

  static Index update_column(const Front& front, Index j) noexcept {
    return front.update_panels().at(0, j - front.pivots) - front.pivots;
  }

  /// Numbers the rows of a front from 0, pivots first.
  void number_rows(const Front& front) noexcept {
    NodeId next = 0;
    for (Index i = 0; i < front.pivots; ++i) local_[front.first + i] = next++;
    for (Index r = front.run_begin; r < front.run_end; ++r)
      for (Index i = 0; i < tree_.runs[r].count; ++i) local_[tree_.runs[r].first + i] = next++;
  }

  /// Adds those columns of the children's updates that belong to columns begin ... end of the front. `column` returns
  /// the address of row 0 of a column.
  template <class Column>
  void add_children(const Front& front, Column&& column, Index begin, Index end) {
    for (NodeId c = front.first_child; c >= 0; c = tree_.fronts[c].next_sibling)
      add_child(tree_.fronts[c], column, begin, end);
  }
  template <class Column>
  void add_child(const Front& child, Column&& column, Index begin, Index end) {
    const LowerPanels shape = child.update_panels();
    match_runs(child);
    const double* const update = workspace_.data() + child.update;
    Index j = 0;
    for (std::size_t r = 0; r < matched_.size(); ++r)
      for (Index in_run = 0; in_run < matched_[r].count; ++in_run, ++j) {
        const Index to_column = matched_[r].to + in_run;
        if (to_column < begin) continue;
        if (to_column >= end) return;
        add_column(update + shape.at(0, j), column(to_column), r, in_run);
      }
  }
  void add_column(const double* from, double* to, std::size_t r, Index skip) noexcept {
    for (; r < matched_.size(); ++r, skip = 0) {
      const Match& m = matched_[r];
      const double* source = from + m.from;
      double* target = to + m.to;
      for (Index i = skip; i < m.count; ++i) target[i] += source[i];
    }
  }

  /// Matches the rows of the child to runs of rows of the front.
  void match_runs(const Front& child) {
    matched_.clear();
    Index from = 0;
    for (Index r = child.run_begin; r < child.run_end; ++r) {
      const Run& run = tree_.runs[r];
      const Index to = local_[run.first];
      if (!matched_.empty() && matched_.back().to + matched_.back().count == to)
        matched_.back().count += run.count;
      else
        matched_.push_back({from, to, run.count});
      from += run.count;
    }
  }

  struct Match {
    Index from, to, count;
  };

  const FrontTree& tree_;
  const double* values_ = nullptr;
  double* factor_;
  BigArray workspace_, packed_;
  const std::vector<Index>& node_of_dof_;
  NodeVector local_;
  VectorX pivots_, diagonal_;
  std::vector<Match> matched_;
};

}}}  // namespace palpate::detail
