// The numerical phase of a multifrontal factorisation (Duff and Reid 1983; Liu 1992): one front.
#pragma once

#include <palpate/linear/detail/big_array.hpp>
#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A factorisation under way, shared by its threads.
struct FrontSystem {
  const FrontTree& tree;
  double* factor;
  double threshold;                  ///< of pivots, relative to the diagonal
  const double* values = nullptr;    ///< of the matrix
  IndexedVector<double*> updates{};  ///< of every front that is eliminated and whose parent is not
  VectorX pivots{}, diagonal{};      ///< in elimination order

  /// Refers to the values of a matrix with the analysed pattern; they must stay valid until elimination is done.
  void refer_to(const SparseLower& lower) noexcept;
  /// Starts with nothing eliminated. Allocates.
  FrontSystem(const FrontTree& fronts, double* columns, double smallest_pivot);
};

/// Workspace of one thread, which eliminates one front after the other. A piece of work of a team is computed alike by
/// any thread, so the result does not depend on the team.
class FrontWork {
 public:
  /// Allocates; the functions do not.
  FrontWork(const FrontTree& tree, Index pack_size);

  /// Eliminates a front whose children are eliminated; its update of later fronts goes to `updates`.
  void eliminate(const FrontSystem& system, Index front, FrontTeam* team) noexcept;
  /// Fills the pivot columns of a front before elimination, and the padding behind them, with entries of the matrix and
  /// updates of the children.
  void assemble(const FrontSystem& system, const Front& front, double* columns, FrontTeam* team) noexcept;
  /// Row in the last front of a place in the elimination order.
  Index row(Index place) const noexcept { return local_[place]; }

 private:
  struct Match {
    Index from, to, count;
  };
  struct Child {
    NodeId front;
    std::size_t begin, end;  ///< of its matches
  };

  void number_rows(const FrontTree& tree, const Front& front) noexcept;
  void match_children(const FrontTree& tree, const Front& front) noexcept;
  void match_runs(const FrontTree& tree, const Front& child) noexcept;
  void add_entries(const FrontSystem& system, const Front& front, double* columns) noexcept;
  template <class Column>
  void add_children(const FrontSystem& system, Index begin, Index end, Column&& column, FrontTeam* team) noexcept;
  template <class Column>
  void add_child(const FrontSystem& system, const Child& child, Index begin, Index end, Column&& column) const noexcept;
  void add_column(const double* from, double* to, std::size_t r, std::size_t end, Index skip) const noexcept;

  const any_flags::Kernels& kernels_;
  BigArray packed_;
  NodeVector local_;
  std::vector<Match> matched_;  // of the rows of all children to rows of the front
  std::vector<Child> children_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/front_work.ipp>
#endif
