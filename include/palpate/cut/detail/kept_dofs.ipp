// Definitions of kept_dofs.hpp.
#pragma once

#include <palpate/cut/detail/kept_dofs.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Index KeptDofs::place(NodeId node, int component) const noexcept {
  const auto i = static_cast<std::size_t>(node);
  return i < place_.size() ? place_[i][static_cast<std::size_t>(component)] : -1;
}

PALPATE_INLINE void KeptDofs::add(const NodeDof& dof) {
  const auto i = static_cast<std::size_t>(dof.node);
  if (i >= place_.size()) place_.resize(i + 1, {-1, -1, -1});
  dofs_.push_back(dof);
  place_[i][static_cast<std::size_t>(dof.component)] = size() - 1;
}

PALPATE_INLINE void KeptDofs::shrink_to(Index size) noexcept {
  for (; this->size() > size; dofs_.pop_back())
    place_[static_cast<std::size_t>(dofs_.back().node)][static_cast<std::size_t>(dofs_.back().component)] = -1;
}

}}  // namespace palpate
