// Preconditioners for the matrix of an implicit step of a co-rotational body.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/model/deformable_body.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>
#include <palpate/model/moving/detail/corotated_solve.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// A = mass M + stiffness K.
struct StepFactors {
  double mass = 0.0, stiffness = 0.0;
  friend bool operator==(const StepFactors&, const StepFactors&) = default;
};

}  // namespace detail

/// Requirements of CorotatedMotion on a preconditioner P for A:
/// - `P(body, rest, limits)`: set-up.
/// - `update(tetrahedra, factors, u, again)`: called before the solves of a step; `again` is true when a renewal is
///   due.
/// - `apply(r, z)`: z = P^-1 r, zero on constrained dofs.
// clang-format off
template <class P, class Tetrahedra>
concept StepPreconditioner =
    std::constructible_from<P, const DeformableBody&, const Body<Tet4>&, const SetupLimits&> &&
    requires(P& p, const P& fixed, const Tetrahedra& tetrahedra, const detail::StepFactors& factors, const VectorX& u,
             VectorX& z) {
      { p.update(tetrahedra, factors, u, true) } noexcept;
      { fixed.apply(u, z) } noexcept;
    };
// clang-format on

/// The inverse 3 x 3 diagonal blocks of A, updated when due. One block product per node and application.
class BlockJacobi {
 public:
  BlockJacobi(const DeformableBody& body, const Body<Tet4>&, const SetupLimits&);

  template <class Tetrahedra>
  void update(const Tetrahedra& tetrahedra, const detail::StepFactors& factors, const VectorX&, bool again) noexcept {
    if (!again) return;
    tetrahedra.diagonal_blocks(straight_, mixed_);
    for (std::size_t i = 0; i < inverse_.size(); ++i) {
      const auto node = static_cast<Index>(i);
      const Vector3 d = node_vector(straight_, node), m = node_vector(mixed_, node);
      Matrix3 a{{d[0], m[0], m[1]}, {m[0], d[1], m[2]}, {m[1], m[2], d[2]}};
      a = factors.stiffness * a;
      for (int c = 0; c < 3; ++c) a(c, c) += factors.mass * lumped_[node];
      hold(constrained_[i], a, inverse_[i]);
    }
  }
  void apply(const VectorX& r, VectorX& z) const noexcept;

 private:
  /// Inverse of the free part of a block, zero elsewhere.
  static void hold(std::uint8_t constrained, Matrix3& a, Matrix3& inverted) noexcept;

  VectorX lumped_;
  std::vector<std::uint8_t> constrained_;
  std::vector<Matrix3> inverse_;
  VectorX straight_, mixed_;
};

/// The factor of A at rest with the rotations of the nodes: R (M + K0)^-1 R^T. Best for long steps. Factorised
/// again when the factors of M and K change, which takes unbounded time; rotations are fitted in every step.
class CorotatedFactor {
 public:
  CorotatedFactor(const DeformableBody& body, const Body<Tet4>& rest, const SetupLimits& limits)
      : corotated_(body),
        lumped_(body.lumped),
        stiffness_(assemble_stiffness<Tet4>(rest, limits)),
        factor_(body.pattern, corotated_.conditions(), body.positions, limits) {}
  CorotatedFactor(const CorotatedFactor&) = delete;
  CorotatedFactor& operator=(const CorotatedFactor&) = delete;

  template <class Tetrahedra>
  void update(const Tetrahedra&, const detail::StepFactors& factors, const VectorX& u, bool) noexcept {
    if (factors != factors_) {
      BlockMatrix& a = factor_.matrix();
      a.set_zero();
      a.add(factors.stiffness, stiffness_);
      a.add_nodal(factors.mass, lumped_);
      factor_.factorise();
      factors_ = factors;
    }
    corotated_.update(u);
  }
  void apply(const VectorX& r, VectorX& z) const noexcept { corotated_.solve(factor_, r, z); }

 private:
  mutable detail::CorotatedSolve corotated_;
  VectorX lumped_;
  BlockMatrix stiffness_;
  mutable detail::TangentSolver factor_;
  detail::StepFactors factors_;
};

inline BlockJacobi::BlockJacobi(const DeformableBody& body, const Body<Tet4>&, const SetupLimits&)
    : lumped_(body.lumped),
      constrained_(body.conditions.constrained),
      straight_(3 * lumped_.size()),
      mixed_(straight_) {
  inverse_.resize(constrained_.size(), Matrix3::Zero());
}

inline void BlockJacobi::apply(const VectorX& r, VectorX& z) const noexcept {
  for (std::size_t i = 0; i < inverse_.size(); ++i) {
    const auto node = static_cast<Index>(i);
    set_node_vector(z, node, inverse_[i] * node_vector(r, node));
  }
}

inline void BlockJacobi::hold(std::uint8_t constrained, Matrix3& a, Matrix3& inverted) noexcept {
  for (int c = 0; c < 3; ++c)
    if (((constrained >> c) & 1u) != 0) {
      for (int i = 0; i < 3; ++i) a(c, i) = a(i, c) = i == c ? 1.0 : 0.0;
    }
  inverted = inverse(a);
  for (int c = 0; c < 3; ++c)
    if (((constrained >> c) & 1u) != 0) inverted(c, c) = 0.0;
}

}}  // namespace palpate
