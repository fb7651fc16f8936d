// The dofs whose compliance is stored.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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
  Index index_of(NodeId node, int component) const noexcept;
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

inline Index KeptDofs::index_of(NodeId node, int component) const noexcept {
  const auto i = static_cast<std::size_t>(node);
  return i < place_.size() ? place_[i][static_cast<std::size_t>(component)] : -1;
}

inline void KeptDofs::add(const NodeDof& dof) {
  const auto i = static_cast<std::size_t>(dof.node);
  if (i >= place_.size()) place_.resize(i + 1, {-1, -1, -1});
  dofs_.push_back(dof);
  place_[i][static_cast<std::size_t>(dof.component)] = size() - 1;
}

inline void KeptDofs::shrink_to(Index size) noexcept {
  for (; this->size() > size; dofs_.pop_back())
    place_[static_cast<std::size_t>(dofs_.back().node)][static_cast<std::size_t>(dofs_.back().component)] = -1;
}

}}}  // namespace palpate::detail
