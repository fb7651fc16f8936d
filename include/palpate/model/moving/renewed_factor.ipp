// Definitions of renewed_factor.hpp.
#pragma once

#include <palpate/model/moving/renewed_factor.hpp>
#include <palpate/assembly/detail/constant_geometry.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/local/geometry.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE RenewedFactor::RenewedFactor(const DeformableBody& body, const Body<Tet4>& rest,
                                            const SetupLimits& limits)
    : corotated_(body),
      lumped_(body.lumped),
      made_{{Made(body, corotated_.conditions(), limits), Made(body, corotated_.conditions(), limits)}},
      asked_(VectorX::Zero(3 * lumped_.size())),
      rest_(asked_),
      thread_([this] { make(spare(), spare().factors, asked_); }) {
  for (Index e = 0; e < rest.mesh.element_count(); ++e) {
    const PointGeometry<Tet4> g = constant_geometry<Tet4>(rest.mesh, e);
    elements_.push_back({rest.mesh.elements[static_cast<std::size_t>(e)], g.gradient, g.volume,
                         *lame_constants(rest.elasticity[rest.region_of(e)])});  // Corotational is isotropic
  }
}

PALPATE_INLINE RenewedFactor::Made::Made(const DeformableBody& body, const EssentialConditions& conditions,
                                         const SetupLimits& limits)
    : factor(std::make_unique<TangentSolver>(body.pattern, conditions, body.positions, limits)),
      rotation(body.positions.size(), Matrix3::Identity()) {}

PALPATE_INLINE void RenewedFactor::make(Made& made, const StepFactors& factors, const VectorX& u) const noexcept {
  corotated_.fit(u, made.rotation);
  BlockMatrix& a = made.factor->matrix();
  a.set_zero();
  for (const RotatingElement& e : elements_) add(e, factors.stiffness, u, a);
  a.add_nodal(factors.mass, lumped_);
  made.usable = made.factor->factorise();
  made.factors = factors;
}

PALPATE_INLINE void RenewedFactor::add(const RotatingElement& e, double factor, const VectorX& u,
                                       BlockMatrix& a) noexcept {
  Matrix3 f = Matrix3::Identity();
  for (int n = 0; n < 4; ++n)
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i) f(i, c) += u[3 * Index{e.nodes[static_cast<std::size_t>(n)]} + i] * e.gradient(n, c);
  if (!all_finite(f)) f.setIdentity();
  const Tensor3<double> t = tensor3<double>(f);
  const Eigen::Matrix<double, 4, 3> g = e.gradient * matrix3(closest_rotation(t)).transpose(),
                                    c = e.gradient * matrix3(cofactor(t)).transpose();
  const LameConstants shear{0.0, e.material.mu}, volume{e.material.lambda, 0.0};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const NodeId row = e.nodes[static_cast<std::size_t>(i)], column = e.nodes[static_cast<std::size_t>(j)];
      if (column > row) continue;
      Matrix3 block = Matrix3::Zero();
      add_isotropic_block(shear, g.row(i), g.row(j), block.data());
      add_isotropic_block(volume, c.row(i), c.row(j), block.data());
      a.block(a.pattern().find(row, column)) += factor * e.volume * block;
    }
}

}}  // namespace palpate
