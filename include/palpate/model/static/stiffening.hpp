// A solver policy for linear tissue that stiffens along measured curves: Stiffening<Condensed<SelectiveInverse>>.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/core/triple_buffer.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/detail/quasi_non_linear.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The static solver `Inner` with a compliance that follows StiffeningCurves; see QuasiNonLinear.
template <class Inner>
struct Stiffening {};

/// Parameters of a model on Stiffening<...>. The default curves leave the tissue linear.
struct StiffeningParameters {
  StiffeningCurve axial{};   ///< along the direction of pressing
  StiffeningCurve radial{};  ///< across it
};

/// Linear static tissue that stiffens: the forces of a tick are those of QuasiNonLinear over the model on `Inner`.
/// Functions without tools (loads, report, energies) are those of the linear model. Neither copyable nor movable.
template <class E, class M, class Inner>
class HapticFEModel<E, M, Stiffening<Inner>> : public HapticFEModel<E, M, Inner> {
  static_assert(SolverPolicy<Inner>,
                "palpate: Stiffening scales a static solver, for example Stiffening<Condensed<SelectiveInverse>>");
  using Linear = HapticFEModel<E, M, Inner>;

 public:
  using MaterialType = M;
  using Parameters = StiffeningParameters;

  /// One material everywhere. Throws as the model on Inner.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const M& material, const SetupOptions& options = {},
                const Parameters& parameters = {})
      : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options, parameters) {}
  /// One material per region.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {}, const Parameters& parameters = {})
      : Linear(mesh, scene, materials, options), stiffened_(*this, parameters.axial, parameters.radial) {
    scales_.fill(stiffened_.scale());
    scaled_.reserve(3 * largest_default_capacity);
  }
  HapticFEModel(const HapticFEModel&) = delete;
  HapticFEModel& operator=(const HapticFEModel&) = delete;

  /// Current ratio of the stiffness to that of the linear tissue, along the force and across it. For the ticking
  /// thread.
  double axial_ratio() const noexcept { return stiffened_.axial_ratio(); }
  double radial_ratio() const noexcept { return stiffened_.radial_ratio(); }

  /// As in the linear model, with the compliance of the newest tick. For one drawing thread. Allocates when there are
  /// more forces than in any earlier call.
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept {
    scales_.update();
    const Matrix3& scale = scales_.front();
    scaled_.assign(forces.begin(), forces.end());
    for (VertexForce& f : scaled_) f.force = ModelVector(scale * f.force.in_model_axes());
    const SolveReport report = Linear::displacement_with(scaled_, u);
    const VectorX& rest = Linear::displacement();
    for (Index i = 0; i < u.size(); i += 3) {
      const Vector3 moved = u.template segment<3>(i) - rest.template segment<3>(i);
      u.template segment<3>(i) = rest.template segment<3>(i) + scale * moved;
    }
    return report;
  }
  using Linear::displacement;
  VectorX displacement(std::span<const VertexForce> forces) {
    VectorX u = Linear::displacement(forces);  // checks the forces
    displacement_with(forces, u);
    return u;
  }
  void reset() {
    Linear::reset();
    stiffened_.reset();
    note_scale();
  }

  // TissueModel
  TissueClaim& claim() noexcept { return stiffened_.claim(); }
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points = {}) noexcept {
    stiffened_.end_tick(forces, points);
    note_scale();
  }
  Matrix3 compliance(int i, int j) const noexcept { return stiffened_.compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return stiffened_.compliance_revision(); }
  double compliance_bound(int j) const noexcept { return stiffened_.compliance_bound(j); }
  double compliance_floor() const noexcept { return stiffened_.compliance_floor(); }

 private:
  void note_scale() noexcept {
    scales_.back() = stiffened_.scale();
    scales_.publish();
  }

  QuasiNonLinear<Linear> stiffened_;
  TripleBuffer<Matrix3> scales_;
  std::vector<VertexForce> scaled_;
};

}}  // namespace palpate
