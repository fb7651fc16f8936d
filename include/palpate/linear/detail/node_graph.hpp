// Coupling graph of the nodes of a sparse symmetric matrix; a node is a group of dofs that are eliminated together.
#pragma once

#include <palpate/linear/detail/indexed_vector.hpp>

#include <Eigen/SparseCore>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Lower half of a symmetric matrix, compressed. Entries above the diagonal are ignored.
using SparseLower = Eigen::SparseMatrix<double, Eigen::ColMajor, Index>;

}  // namespace detail

/// Optional information about the dofs of a matrix; every field may be empty.
struct DofLayout {
  std::vector<Index> node_of_dof;  ///< per dof its node; empty: found from equal rows
  std::vector<Vector3> positions;  ///< per node id its coordinates [m]; empty: ordered by the graph alone
  std::vector<Index> kept;         ///< dofs to eliminate last; the Schur complement has this order
};

namespace detail {

/// Undirected graph of nodes without loops. Every node has at least one dof; all dofs of a node are kept, or none.
struct NodeGraph {
  OffsetVector start;              ///< nodes + 1 offsets into neighbour
  NodeVector neighbour;            ///< both directions of every edge
  OffsetVector dof_start;          ///< nodes + 1 offsets into dof
  IndexedVector<Index> dof;        ///< dofs of every node, ascending
  NodeVector node_of_dof;          ///< inverse of `dof`
  IndexedVector<char> kept;        ///< per node
  std::vector<Vector3> positions;  ///< per node, or empty

  Index nodes() const noexcept { return start.size() - 1; }
  Index weight(Index node) const noexcept { return dof_start[node + 1] - dof_start[node]; }
};

/// Builds the graph of a matrix. O(nonzeros), allocates. Throws bad_argument when the layout does not fit the matrix.
NodeGraph node_graph(const SparseLower& lower, const DofLayout& layout);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/detail/node_graph.ipp>
#endif
