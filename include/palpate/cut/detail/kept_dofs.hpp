// The dofs whose compliance is stored.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A node and a component.
struct NodeDof {
  NodeId node = 0;
  int component = 0;
};

/// Kept dofs, numbered in the order in which they were added.
class KeptDofs {
 public:
  Index size() const noexcept { return static_cast<Index>(dofs_.size()); }
  const NodeDof& operator[](Index i) const noexcept { return dofs_[static_cast<std::size_t>(i)]; }
  /// Index of a dof, -1 when it is not kept.
  Index place(NodeId node, int component) const noexcept;
  /// Strong guarantee.
  void add(const NodeDof& dof);
  /// Removes those after the first `size`.
  void shrink_to(Index size) noexcept;
  /// The entry of kept dof i in a vector with three values per node.
  double& at(VectorX& u, Index i) const noexcept { return u[3 * Index{(*this)[i].node} + (*this)[i].component]; }
  double at(const VectorX& u, Index i) const noexcept { return u[3 * Index{(*this)[i].node} + (*this)[i].component]; }

 private:
  std::vector<std::array<Index, 3>> place_;  // by node
  std::vector<NodeDof> dofs_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/kept_dofs.ipp>
#endif
