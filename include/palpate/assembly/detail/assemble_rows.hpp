// Row-by-row assembly of the stiffness of elements with constant gradients.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/constant_geometry.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/mesh/mesh.hpp>

#include <array>
#include <cmath>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Spatial gradients of all elements times the square root of the volume; K_ab is a sum of products of these.
template <ConstantGradient E>
class ScaledGradients {
 public:
  using Gradients = std::array<Vector3, E::nodes>;

  /// Throws inverted_element for a volume that is not positive, non_finite for one that is not finite.
  explicit ScaledGradients(const Mesh<E>& mesh) : values_(static_cast<std::size_t>(mesh.element_count())) {
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const PointGeometry<E> g = constant_geometry(mesh, e);
      const double scale = std::sqrt(g.volume);
      for (int a = 0; a < E::nodes; ++a)
        for (int i = 0; i < 3; ++i)
          values_[static_cast<std::size_t>(e)][static_cast<std::size_t>(a)][i] = scale * g.gradient.coeff(a, i);
    }
  }
  const Gradients& operator[](Index e) const noexcept { return values_[static_cast<std::size_t>(e)]; }

 private:
  std::vector<Gradients> values_;
};

/// Fills `k` with the stiffness of isotropic elements. Every block is completed while its row is in cache; no element
/// matrix is formed. About E::nodes^2 / 2 blocks of 25 multiplications per element; allocates the gradients.
template <ConstantGradient E>
void assemble_rows(const Mesh<E>& mesh, const NodeElements& around, const std::vector<LameConstants>& region,
                   BlockMatrix& k, const SetupLimits& limits) {
  limits.require_memory(static_cast<double>(mesh.element_count()) * sizeof(typename ScaledGradients<E>::Gradients),
                        "the gradients of all elements");
  const ScaledGradients<E> gradients(mesh);
  const BlockPattern& pattern = k.pattern();
  std::vector<Index> place(static_cast<std::size_t>(pattern.rows()), -1);  // position of a column in the current row
  for (Index i = 0; i < pattern.rows(); ++i) {
    if (i % 8192 == 0) limits.advance("assembly", static_cast<double>(i) / static_cast<double>(pattern.rows()));
    for (Index p = pattern.row_start[static_cast<std::size_t>(i)];
         p < pattern.row_start[static_cast<std::size_t>(i) + 1]; ++p)
      place[static_cast<std::size_t>(pattern.column[static_cast<std::size_t>(p)])] = p;
    for (const NodeId e : around.of(i)) {
      const auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
      const auto& g = gradients[e];
      const LameConstants& c = region[static_cast<std::size_t>(mesh.region(e))];
      Vector3 own = g[0];
      for (std::size_t a = 1; a < E::nodes; ++a)
        if (nodes[a] == i) own = g[a];
      for (std::size_t b = 0; b < E::nodes; ++b) {
        const Index j = nodes[b];
        if (j <= i) add_isotropic_block(c, own, g[b], k.block(place[static_cast<std::size_t>(j)]).data());
      }
    }
  }
}

}}  // namespace palpate
