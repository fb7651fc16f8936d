// The mass of a body: consistent, and lumped at the nodes. (Row sums, for gravity, are in load_vector.hpp.)
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/mass.hpp>
#include <palpate/mesh/mesh.hpp>

#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// The consistent mass matrix [kg]: one number per pair of neighbouring nodes, lower half stored; every block is that
/// number times the identity. A ninth of the memory of a BlockMatrix.
class MassMatrix {
 public:
  MassMatrix() = default;
  explicit MassMatrix(BlockPattern pattern) : pattern_(std::move(pattern)), values_(pattern_.column.size(), 0.0) {}

  Index size() const noexcept { return 3 * pattern_.rows(); }
  const BlockPattern& pattern() const noexcept { return pattern_; }
  std::size_t bytes() const noexcept {
    return values_.size() * (sizeof(double) + sizeof(NodeId)) + pattern_.row_start.size() * sizeof(Index);
  }

  /// Mass of a pair of nodes at a position given by the pattern [kg].
  double& operator[](Index position) noexcept { return values_[static_cast<std::size_t>(position)]; }
  double operator[](Index position) const noexcept { return values_[static_cast<std::size_t>(position)]; }

  /// y = M x; x and y have size() entries. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept;

 private:
  BlockPattern pattern_;
  std::vector<double> values_;
};

/// Throws for an invalid mass: an inverted element, or numbers that are not finite.
inline void require_mass(double volume, double mass, Index e) {
  if (!std::isfinite(mass)) raise_element(SetupErrorKind::non_finite, e, "has a mass that is not finite");
  if (!(volume > 0.0)) raise_element(SetupErrorKind::inverted_element, e, "has no positive volume");
}

}  // namespace detail

/// Consistent mass of a body (thesis 3.48). Total mass, centre of mass and inertia of a rigid motion are exact. Throws
/// inverted_element, non_finite or too_large. O(elements x nodes_per_element^2), allocates the pattern and the values.
template <Element E>
detail::MassMatrix assemble_mass(const Body<E>& body, const SetupLimits& limits = {}) {
  detail::BlockPattern pattern = detail::block_pattern(body.mesh);
  limits.require_memory(static_cast<double>(pattern.column.size()) * sizeof(double), "the mass");
  detail::MassMatrix m(std::move(pattern));
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    if (e % 8192 == 0)
      limits.advance("assembly", static_cast<double>(e) / static_cast<double>(body.mesh.element_count()));
    const detail::ElementMass<E> volumes = detail::element_mass<E>(element_nodes<E>(body.mesh, e));
    const detail::ElementMass<E> me = body.density[body.region_of(e)] * volumes;
    detail::require_mass(volumes.sum(), me.sum(), e);
    const auto& nodes = body.mesh.elements[static_cast<std::size_t>(e)];
    for (int a = 0; a < E::nodes; ++a)
      for (int b = 0; b < E::nodes; ++b) {
        const NodeId i = nodes[static_cast<std::size_t>(a)], j = nodes[static_cast<std::size_t>(b)];
        if (j <= i) m[m.pattern().find(i, j)] += me(a, b);
      }
  }
  return m;
}

/// Lumped mass [kg], one entry per node, by diagonal scaling (local/mass.hpp): positive wherever the density is, and
/// the total is exact. Used as divisor in explicit integration. Throws inverted_element or
/// non_finite.
template <Element E>
VectorX lumped_mass(const Body<E>& body) {
  VectorX mass = VectorX::Zero(body.mesh.node_count());
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto volumes = detail::lumped_element_mass<E>(element_nodes<E>(body.mesh, e));
    const double density = body.density[body.region_of(e)];
    detail::require_mass(volumes.sum(), density * volumes.sum(), e);
    for (int a = 0; a < E::nodes; ++a) mass[body.mesh.element_node(e, a)] += density * volumes[a];
  }
  return mass;
}

/// Calls visit(row, column, value) for every stored entry of the lower half of the mass of the free dofs, rows
/// ascending within a column; used by free_matrix.
template <class Visit>
void for_each_free_entry(const detail::MassMatrix& m, const EssentialConditions& conditions, Visit&& visit) {
  const detail::BlockPattern& pattern = m.pattern();
  const auto free = [&](Index node, Index c) { return conditions.free_index[static_cast<std::size_t>(3 * node + c)]; };
  for (Index i = 0; i < pattern.rows(); ++i)
    for (Index p = pattern.row_start[static_cast<std::size_t>(i)];
         p < pattern.row_start[static_cast<std::size_t>(i) + 1]; ++p)
      for (Index c = 0; c < 3; ++c) {
        const Index row = free(i, c), column = free(pattern.column[static_cast<std::size_t>(p)], c);
        if (row >= 0 && column >= 0) visit(row, column, m[p]);
      }
}

namespace detail {

inline void MassMatrix::apply(const VectorX& x, VectorX& y) const noexcept {
  y.setZero();
  for (Index i = 0; i < pattern_.rows(); ++i) {
    const Index last = pattern_.row_start[static_cast<std::size_t>(i) + 1] - 1;
    const double x0 = x[3 * i], x1 = x[3 * i + 1], x2 = x[3 * i + 2], diagonal = (*this)[last];
    double y0 = diagonal * x0, y1 = diagonal * x1, y2 = diagonal * x2;
    for (Index p = pattern_.row_start[static_cast<std::size_t>(i)]; p < last; ++p) {
      const Index j = pattern_.column[static_cast<std::size_t>(p)];
      const double m = (*this)[p];
      const double* const xj = x.data() + 3 * j;
      y0 += m * xj[0];
      y1 += m * xj[1];
      y2 += m * xj[2];
      double* const yj = y.data() + 3 * j;
      yj[0] += m * x0;
      yj[1] += m * x1;
      yj[2] += m * x2;
    }
    y[3 * i] += y0;
    y[3 * i + 1] += y1;
    y[3 * i + 2] += y2;
  }
}

}  // namespace detail

}}  // namespace palpate
