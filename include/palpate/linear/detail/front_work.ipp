// Definitions of front_work.hpp.
#pragma once

#include <palpate/linear/detail/front_work.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE FrontSystem::FrontSystem(const FrontTree& fronts, double* columns, double smallest_pivot)
    : tree(fronts),
      factor(columns),
      threshold(smallest_pivot),
      updates(fronts.fronts.size(), nullptr),
      pivots(fronts.place_of_dof.size()),
      diagonal(zeros(fronts.place_of_dof.size())) {}

PALPATE_INLINE void FrontSystem::refer_to(const SparseLower& lower) noexcept {
  values = lower.valuePtr();
  for (Index j = 0; j < lower.cols(); ++j)
    for (Index p = lower.outerIndexPtr()[j]; p < lower.outerIndexPtr()[j + 1]; ++p)
      if (lower.innerIndexPtr()[p] == j) diagonal.data()[tree.place_of_dof[j]] = values[p];
}

PALPATE_INLINE FrontWork::FrontWork(const FrontTree& tree, Index pack_size)
    : kernels_(processor_kernels()), packed_(pack_size), local_(tree.place_of_dof.size(), 0) {
  Index most_runs = 0, most_children = 0;
  for (const Front& front : tree.fronts) {
    Index runs = 0, children = 0;
    for (NodeId c = front.first_child; c >= 0; c = tree.fronts[c].next_sibling, ++children)
      runs += tree.fronts[c].run_end - tree.fronts[c].run_begin;
    most_runs = std::max(most_runs, runs);
    most_children = std::max(most_children, children);
  }
  matched_.reserve(static_cast<std::size_t>(most_runs));
  children_.reserve(static_cast<std::size_t>(most_children));
}

PALPATE_INLINE void FrontWork::eliminate(const FrontSystem& system, Index f, FrontTeam* team) noexcept {
  const Front& front = system.tree.fronts[f];
  double* const columns = system.factor + front.factor;
  double* const update = system.updates[f];
  assemble(system, front, columns, team);
  kernels_.factor_front({columns, front.pivots, front.rows, update, front.first,
                         const_cast<double*>(system.pivots.data()), system.diagonal.data(), system.threshold,
                         packed_.data(), team});
  const LowerPanels shape = front.update_panels();
  add_children(
      system, front.pivots, front.size(),
      [&](Index j) { return update + shape.at(0, j - front.pivots) - front.pivots; }, team);
}

PALPATE_INLINE void FrontWork::assemble(const FrontSystem& system, const Front& front, double* columns,
                                        FrontTeam* team) noexcept {
  constexpr Index piece = Index{1} << 18;  // doubles: a huge page
  const LowerPanels shape = front.panels();
  const Index size = shape.size() + Front::padding;
  share(team, (size + piece - 1) / piece,
        [&](Index i) { std::fill(columns + i * piece, columns + std::min(size, (i + 1) * piece), 0.0); });
  number_rows(system.tree, front);
  match_children(system.tree, front);
  add_entries(system, front, columns);
  add_children(
      system, 0, front.pivots, [&](Index j) { return columns + shape.at(0, j); }, team);
}

PALPATE_INLINE void FrontWork::add_entries(const FrontSystem& system, const Front& front, double* columns) noexcept {
  const LowerPanels shape = front.panels();
  for (NodeId e = front.first_entry; e >= 0; e = system.tree.entries[e].next) {
    const EntryRun& run = system.tree.entries[e];
    const double* value = system.values + run.source;
    if (run.count > 0) {
      double* to = columns + shape.at(local_[run.row], local_[run.column]);
      for (Index i = 0; i < run.count; ++i) to[i] += value[i];
    } else {
      for (Index i = 0; i < -run.count; ++i) columns[shape.at(local_[run.row], local_[run.column] + i)] += value[i];
    }
  }
}

/// Numbers the rows of a front from 0, pivots first.
PALPATE_INLINE void FrontWork::number_rows(const FrontTree& tree, const Front& front) noexcept {
  NodeId next = 0;
  for (Index i = 0; i < front.pivots; ++i) local_[front.first + i] = next++;
  for (Index r = front.run_begin; r < front.run_end; ++r)
    for (Index i = 0; i < tree.runs[r].count; ++i) local_[tree.runs[r].first + i] = next++;
}

PALPATE_INLINE void FrontWork::match_children(const FrontTree& tree, const Front& front) noexcept {
  matched_.clear();
  children_.clear();
  for (NodeId c = front.first_child; c >= 0; c = tree.fronts[c].next_sibling) {
    const std::size_t begin = matched_.size();
    match_runs(tree, tree.fronts[c]);
    children_.push_back({c, begin, matched_.size()});
  }
}

/// Matches the rows of a child to runs of rows of the front.
PALPATE_INLINE void FrontWork::match_runs(const FrontTree& tree, const Front& child) noexcept {
  const std::size_t begin = matched_.size();
  Index from = 0;
  for (Index r = child.run_begin; r < child.run_end; ++r) {
    const Run& run = tree.runs[r];
    const Index to = local_[run.first];
    if (matched_.size() > begin && matched_.back().to + matched_.back().count == to)
      matched_.back().count += run.count;
    else
      matched_.push_back({from, to, run.count});
    from += run.count;
  }
}

/// Adds those columns of the children's updates that belong to columns begin ... end of the front. `column` returns
/// the address of row 0 of a column.
template <class Column>
void FrontWork::add_children(const FrontSystem& system, Index begin, Index end, Column&& column,
                             FrontTeam* team) noexcept {
  const Index piece = team != nullptr ? 64 : std::max<Index>(1, end - begin);
  share(team, (end - begin + piece - 1) / piece, [&](Index i) {
    const Index first = begin + i * piece, last = std::min(end, first + piece);
    for (const Child& child : children_) add_child(system, child, first, last, column);
  });
}

template <class Column>
void FrontWork::add_child(const FrontSystem& system, const Child& child, Index begin, Index end,
                          Column&& column) const noexcept {
  const LowerPanels shape = system.tree.fronts[child.front].update_panels();
  const double* const update = system.updates[child.front];
  for (std::size_t r = child.begin; r < child.end; ++r) {
    const Match& m = matched_[r];
    if (m.to >= end) return;
    for (Index i = std::max<Index>(0, begin - m.to); i < m.count && m.to + i < end; ++i)
      add_column(update + shape.at(0, m.from + i), column(m.to + i), r, child.end, i);
  }
}

PALPATE_INLINE void FrontWork::add_column(const double* from, double* to, std::size_t r, std::size_t end,
                                          Index skip) const noexcept {
  for (; r < end; ++r, skip = 0) {
    const Match& m = matched_[r];
    const double* source = from + m.from;
    double* target = to + m.to;
    for (Index i = skip; i < m.count; ++i) target[i] += source[i];
  }
}

}}}  // namespace palpate::detail
