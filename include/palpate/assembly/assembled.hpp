// Assembly policy: the stiffness is stored.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/assemble_rows.hpp>
#include <palpate/assembly/detail/constant_geometry.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/assembler.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/local/stiffness.hpp>
#include <palpate/mesh/mesh.hpp>

#include <optional>

namespace palpate { inline namespace PALPATE_ABI {

static_assert(StiffnessOperator<BlockMatrix>);

/// Fills `k` element by element, for any element and material. `material(e)` is passed to element_stiffness: a matrix
/// or Lame's constants.
template <Element E, class MaterialOf>
void assemble_elements(const Body<E>& body, BlockMatrix& k, const SetupLimits& limits, MaterialOf material) {
  const Index count = body.mesh.element_count();
  for (Index e = 0; e < count; ++e) {
    if (e % 8192 == 0) limits.advance("assembly", static_cast<double>(e) / static_cast<double>(count));
    const ElementNodes<E> x = element_nodes<E>(body.mesh, e);
    const ElementStiffness<E> ke = element_stiffness<E>(x, material(e));
    if (!all_finite(ke)) raise_element(SetupErrorKind::non_finite, e, "has a stiffness that is not finite");
    if (!is_positively_oriented<E>(x))
      raise_element(SetupErrorKind::inverted_element, e, "has a negative Jacobian at an integration point");
    const auto& nodes = body.mesh.elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < E::nodes; ++a)
      for (int b = 0; b < E::nodes; ++b) {
        const NodeId i = nodes[static_cast<std::size_t>(a)], j = nodes[static_cast<std::size_t>(b)];
        if (j > i) continue;
        double* const block = k.block(k.pattern().find(i, j)).data();
        for (int d = 0; d < 3; ++d)
          for (int c = 0; c < 3; ++c) block[3 * d + c] += ke.coeff(3 * a + c, 3 * b + d);
      }
  }
}

/// Sums all element stiffnesses into the block pattern (thesis 3.37, 3.46). Throws inverted_element for a negative
/// Jacobian and non_finite for an element whose stiffness is not finite. Allocates the pattern, the values and the
/// workspace of assemble_rows.
template <Element E>
BlockMatrix assemble_stiffness(const Body<E>& body, const SetupLimits& limits) {
  const NodeElements around(body.mesh);
  BlockMatrix k = make_stiffness(block_pattern(body.mesh, around), limits);
  const auto constants =
      body.materials.empty() ? all_isotropic(body.elasticity) : std::nullopt;  // per region, if all are isotropic
  if (!constants)
    assemble_elements(body, k, limits, [&](Index e) -> const Matrix6& { return body.elasticity_of(e); });
  else if constexpr (ConstantGradient<E>)
    assemble_rows<E>(body.mesh, around, *constants, k, limits);
  else
    assemble_elements(body, k, limits,
                      [&](Index e) -> const LameConstants& { return (*constants)[body.region_of(e)]; });
  return k;
}

/// Stores K as 3 x 3 blocks: about 0.6 kB per Tet4 node (lower half); needed by every direct solver.
struct Assembled {
  template <Element E>
  using Operator = BlockMatrix;

  template <Element E>
  static BlockMatrix make(const Body<E>& body, const SetupLimits& limits) {
    return assemble_stiffness<E>(body, limits);
  }
};

}}  // namespace palpate
