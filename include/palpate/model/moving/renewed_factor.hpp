// A factor that a background thread recomputes while steps continue with the previous one.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/rotation.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/detail/corotated_solve.hpp>
#include <palpate/model/moving/detail/renewal_thread.hpp>
#include <palpate/model/moving/step_preconditioners.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>

#include <array>
#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Preconditioner of CorotatedMotion: the factor of A at a recent state s, rotated from there with the nodes, (R R_s^T)
/// A_s^-1 (R R_s^T)^T (asynchronous preconditioning, Courtecuisse et al. 2010). When a renewal is due and the thread is
/// idle, an update passes the state to the thread; the next update takes a finished factor. No update waits, except the
/// first after the factors of M and K have changed, which factorises at rest. Stores two factors.
class RenewedFactor {
 public:
  RenewedFactor(const DeformableBody& body, const Body<Tet4>& rest, const SetupLimits& limits);

  template <class Tetrahedra>
  void update(const Tetrahedra&, const detail::StepFactors& factors, const VectorX& u, bool again) noexcept {
    if (thread_.finished()) {
      if (spare().usable && spare().factors == factors) {
        front_ = 1 - front_;
        ++renewals_;
      }
      thread_.set_idle();
    }
    if (front().factors != factors) {
      make(front(), factors, rest_);
    } else if (again && thread_.idle()) {
      asked_ = u;
      spare().factors = factors;
      thread_.ask();
    }
    corotated_.update(u, front().rotation);
  }
  void apply(const VectorX& r, VectorX& z) const noexcept { corotated_.solve(*made_[front_].factor, r, z); }
  /// Number of factors taken from the thread so far.
  long renewals() const noexcept { return renewals_; }

 private:
  struct RotatingElement {
    std::array<NodeId, 4> nodes;
    Eigen::Matrix<double, 4, 3> gradient;
    double volume;
    detail::LameConstants material;
  };
  struct Made {
    Made(const DeformableBody& body, const EssentialConditions& conditions, const SetupLimits& limits)
        : factor(std::make_unique<detail::TangentSolver>(body.pattern, conditions, body.positions, limits)),
          rotation(body.positions.size(), Matrix3::Identity()) {}
    std::unique_ptr<detail::TangentSolver> factor;
    std::vector<Matrix3> rotation;  // of the nodes in the state of the factor
    detail::StepFactors factors;
    bool usable = false;
  };

  Made& front() noexcept { return made_[front_]; }
  Made& spare() noexcept { return made_[1 - front_]; }

  /// A at a state, and its factor.
  void make(Made& made, const detail::StepFactors& factors, const VectorX& u) const noexcept;
  /// Stiffness of one element, as in CorotatedTetrahedra.
  static void add(const RotatingElement& e, double factor, const VectorX& u, BlockMatrix& a) noexcept;

  mutable detail::CorotatedSolve corotated_;
  VectorX lumped_;
  std::vector<RotatingElement> elements_;
  std::array<Made, 2> made_;
  std::size_t front_ = 0;
  VectorX asked_;  // used by the thread while it works
  VectorX rest_;   // no displacement
  long renewals_ = 0;
  detail::RenewalThread thread_;  // last: it uses all other members
};

inline RenewedFactor::RenewedFactor(const DeformableBody& body, const Body<Tet4>& rest, const SetupLimits& limits)
    : corotated_(body),
      lumped_(body.lumped),
      made_{{Made(body, corotated_.conditions(), limits), Made(body, corotated_.conditions(), limits)}},
      asked_(VectorX::Zero(3 * lumped_.size())),
      rest_(asked_),
      thread_([this] { make(spare(), spare().factors, asked_); }) {
  for (Index e = 0; e < rest.mesh.element_count(); ++e) {
    const detail::PointGeometry<Tet4> g = detail::constant_geometry<Tet4>(rest.mesh, e);
    elements_.push_back({rest.mesh.elements[static_cast<std::size_t>(e)], g.gradient, g.volume,
                         *detail::lame_constants(rest.elasticity[rest.region_of(e)])});  // Corotational is isotropic
  }
}

inline void RenewedFactor::make(Made& made, const detail::StepFactors& factors, const VectorX& u) const noexcept {
  corotated_.fit(u, made.rotation);
  BlockMatrix& a = made.factor->matrix();
  a.set_zero();
  for (const RotatingElement& e : elements_) add(e, factors.stiffness, u, a);
  a.add_nodal(factors.mass, lumped_);
  made.usable = made.factor->factorise();
  made.factors = factors;
}

inline void RenewedFactor::add(const RotatingElement& e, double factor, const VectorX& u, BlockMatrix& a) noexcept {
  Matrix3 f = Matrix3::Identity();
  for (int n = 0; n < 4; ++n)
    for (int c = 0; c < 3; ++c)
      for (int i = 0; i < 3; ++i) f(i, c) += u[3 * Index{e.nodes[static_cast<std::size_t>(n)]} + i] * e.gradient(n, c);
  if (!all_finite(f)) f.setIdentity();
  const Tensor3<double> t = tensor3<double>(f);
  const Eigen::Matrix<double, 4, 3> g = e.gradient * matrix3(closest_rotation(t)).transpose(),
                                    c = e.gradient * matrix3(cofactor(t)).transpose();
  const detail::LameConstants shear{0.0, e.material.mu}, volume{e.material.lambda, 0.0};
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j) {
      const NodeId row = e.nodes[static_cast<std::size_t>(i)], column = e.nodes[static_cast<std::size_t>(j)];
      if (column > row) continue;
      Matrix3 block = Matrix3::Zero();
      detail::add_isotropic_block(shear, g.row(i), g.row(j), block.data());
      detail::add_isotropic_block(volume, c.row(i), c.row(j), block.data());
      a.block(a.pattern().find(row, column)) += factor * e.volume * block;
    }
}

}}  // namespace palpate
