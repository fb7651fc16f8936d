// The fronts of a multifrontal factorisation: sizes, rows, and where everything goes in memory.
#pragma once

#include <palpate/linear/detail/indexed_vector.hpp>
#include <palpate/linear/detail/lower_panels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A stretch of consecutive places in the elimination order.
struct Run {
  NodeId first = 0, count = 0;
};

/// Entries of the matrix at consecutive places of its value array that go to one column of a front (count > 0) or to
/// one row (count < 0).
struct EntryRun {
  Index source = 0;
  NodeId column = 0, row = 0;  ///< places in the elimination order of the first
  NodeId count = 0;
  NodeId next = -1;  ///< further entries of the same front
};

/// One dense front: `pivots` columns are eliminated, `rows` more are updated.
struct Front {
  Index first = 0;                   ///< place of the first pivot in the elimination order
  Index pivots = 0, rows = 0;        ///< dofs
  Index factor = 0;                  ///< where its columns of L start [doubles]
  Index update = 0;                  ///< where its update of later fronts starts in the workspace [doubles]
  Index run_begin = 0, run_end = 0;  ///< its rows
  NodeId first_entry = -1;           ///< its entries of the matrix, a chain
  NodeId parent = -1, first_child = -1, next_sibling = -1;

  Index size() const noexcept { return pivots + rows; }
  LowerPanels panels() const noexcept { return LowerPanels::of(pivots + rows, pivots); }
  LowerPanels update_panels() const noexcept { return LowerPanels::of(rows, rows); }
  double nonzeros() const noexcept {
    const auto k = static_cast<double>(pivots), m = static_cast<double>(size());
    return k * m - 0.5 * k * (k - 1.0);
  }
  double flops() const noexcept {  // sum of squares of the column lengths
    const auto k = static_cast<double>(pivots), m = static_cast<double>(size());
    return k * (m * (m - k + 1.0) + (k - 1.0) * (2.0 * k - 1.0) / 6.0);
  }
};

/// All fronts, children before parents.
struct FrontTree {
  IndexedVector<Front> fronts;
  IndexedVector<Run> runs;
  IndexedVector<EntryRun> entries;
  NodeVector place_of_dof;   ///< place of every dof in the elimination order
  NodeVector front_of_dof;   ///< the front that eliminates it
  Index factor_size = 0;     ///< [doubles]
  Index workspace_size = 0;  ///< updates alive at once, at most [doubles]
  Index largest_front = 0;   ///< rows
  double nonzeros = 0.0, flops = 0.0;
};

}}}  // namespace palpate::detail
