// The stiffness of a whole mesh as an operator, assembled or matrix-free.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The stiffness of all dofs of a mesh, constrained ones included (x y z per node). `apply` computes y = K x [N]
/// without allocating; `diagonal_blocks` returns the 3 x 3 block of every node. Laws: testing/assembler_laws.hpp.
template <class K>
concept StiffnessOperator = requires(const K& k, const VectorX& x, VectorX& y) {
  { k.size() } -> std::convertible_to<Index>;
  { k.apply(x, y) } noexcept;
  { k.diagonal_blocks() } -> std::same_as<std::vector<Matrix3>>;
  { k.bytes() } -> std::convertible_to<std::size_t>;
};

}}  // namespace palpate
