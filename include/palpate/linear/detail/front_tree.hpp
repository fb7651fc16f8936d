// The fronts of a multifrontal factorisation: sizes, rows and memory layout.
#pragma once

#include <palpate/linear/detail/indexed_vector.hpp>
#include <palpate/linear/detail/lower_panels.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A run of consecutive places in the elimination order.
struct Run {
  NodeId first = 0, count = 0;
};

/// Entries that are consecutive in the value array of the matrix and go to one column of a front (count > 0) or to one
/// row (count < 0).
struct EntryRun {
  Index source = 0;
  NodeId column = 0, row = 0;  ///< places of the first entry in the elimination order
  NodeId count = 0;
  NodeId next = -1;  ///< next run of entries of the same front
};

/// One dense front: `pivots` columns are eliminated, `rows` more are updated.
struct Front {
  Index first = 0;                   ///< place of the first pivot in the elimination order
  Index pivots = 0, rows = 0;        ///< dofs
  Index factor = 0;                  ///< offset of its columns of L [doubles]
  Index update = 0;                  ///< offset in the workspace of its update of later fronts [doubles]
  Index run_begin = 0, run_end = 0;  ///< its rows
  NodeId first_entry = -1;           ///< first run of its matrix entries, a linked list
  NodeId parent = -1, first_child = -1, next_sibling = -1;

  Index size() const noexcept { return pivots + rows; }
  /// Zeros behind the columns of a front, which kernels read past their end.
  static constexpr Index padding = LowerPanels::alignment;
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
  Index workspace_size = 0;  ///< largest total size of simultaneously stored updates [doubles]
  Index largest_front = 0;   ///< rows
  double nonzeros = 0.0, flops = 0.0;
};

}}}  // namespace palpate::detail
