// Assembly policy: the stiffness is applied element by element and never stored.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/integration_points.hpp>
#include <palpate/mesh/mesh.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// K x by gathering each element's displacements, computing its stress and scattering its nodal forces. Stores only
/// gradients and volumes.
template <Element E>
class MatrixFreeStiffness {
 public:
  MatrixFreeStiffness() = default;

  /// Throws as assemble_stiffness does.
  MatrixFreeStiffness(const Body<E>& body, const SetupLimits& limits)
      : nodes_(body.mesh.node_count()), connectivity_(body.mesh.elements), elasticity_(body.elasticity) {
    const Index count = body.mesh.element_count();
    limits.require_memory(static_cast<double>(count) * E::Quadrature::points.size() * sizeof(IntegrationPoint<E>),
                          "the element gradients");
    materials_.reserve(static_cast<std::size_t>(count));
    points_.reserve(static_cast<std::size_t>(count) * E::Quadrature::points.size());
    for (Index e = 0; e < count; ++e) {
      if (e % 8192 == 0) limits.advance("assembly", static_cast<double>(e) / static_cast<double>(count));
      materials_.push_back(body.material_of(e));
      for (const IntegrationPoint<E>& point : integration_points<E>(element_nodes<E>(body.mesh, e))) {
        points_.push_back(point);
        if (!all_finite(points_.back().gradient))
          raise_element(SetupErrorKind::non_finite, e, "has a stiffness that is not finite");
      }
    }
  }

  Index size() const noexcept { return 3 * nodes_; }
  std::size_t bytes() const noexcept {
    return points_.size() * sizeof(points_[0]) + connectivity_.size() * sizeof(connectivity_[0]) +
           materials_.size() * sizeof(std::size_t) + elasticity_.size() * sizeof(Matrix6);
  }

  /// y = K x. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept {
    y.setZero();
    auto geometry = points_.begin();
    for (std::size_t e = 0; e < connectivity_.size(); ++e) {
      ElementNodes<E> u;
      for (int a = 0; a < E::nodes; ++a)
        for (int c = 0; c < 3; ++c) u.coeffRef(a, c) = x[3 * Index{connectivity_[e][static_cast<std::size_t>(a)]} + c];
      ElementNodes<E> f = ElementNodes<E>::Zero();
      for (std::size_t q = 0; q < E::Quadrature::points.size(); ++q, ++geometry) {
        const Vector6 stress = elasticity_[materials_[e]] * strain_at<E>(*geometry, u);
        f += force_of_stress<E>(*geometry, stress);
      }
      for (int a = 0; a < E::nodes; ++a)
        for (int c = 0; c < 3; ++c) y[3 * Index{connectivity_[e][static_cast<std::size_t>(a)]} + c] += f.coeff(a, c);
    }
  }

  std::vector<Matrix3> diagonal_blocks() const {
    std::vector<Matrix3> d(static_cast<std::size_t>(nodes_), Matrix3::Zero());
    auto geometry = points_.begin();
    for (std::size_t e = 0; e < connectivity_.size(); ++e)
      for (std::size_t q = 0; q < E::Quadrature::points.size(); ++q, ++geometry)
        for (int a = 0; a < E::nodes; ++a) {
          const StrainBlock b = strain_block<E>(*geometry, a);
          d[static_cast<std::size_t>(connectivity_[e][static_cast<std::size_t>(a)])] +=
              force_block(b, stress_block(geometry->volume, elasticity_[materials_[e]], b));
        }
    return d;
  }

 private:
  Index nodes_ = 0;
  std::vector<typename Mesh<E>::Connectivity> connectivity_;
  std::vector<std::size_t> materials_;
  std::vector<IntegrationPoint<E>> points_;
  std::vector<Matrix6> elasticity_;
};

template <HasSmoothedStrain E>
class MatrixFreeStiffness<E> : public SmoothedStiffness<E> {
 public:
  using SmoothedStiffness<E>::SmoothedStiffness;
};

}  // namespace detail

/// Stores no matrix, only the gradients and volumes of the elements; for iterative solvers.
struct MatrixFree {
  template <Element E>
  using Operator = detail::MatrixFreeStiffness<E>;

  template <Element E>
  static detail::MatrixFreeStiffness<E> make(const Body<E>& body, const SetupLimits& limits) {
    return detail::MatrixFreeStiffness<E>(body, limits);
  }
};

}}  // namespace palpate
