// Linear tissue that stiffens along measured curves; the solver policy Stiffening<Condensed<SelectiveInverse>>.
#pragma once

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Ratio of the force at a displacement to that of the linear tissue: points (displacement [m], ratio [-]) that start
/// at displacement 0, with linear interpolation and a constant ratio beyond the last point.
class StiffeningCurve {
 public:
  struct Point {
    double displacement = 0.0, ratio = 1.0;
  };

  /// Linear tissue: the ratio is 1 everywhere.
  StiffeningCurve() : points_{{0.0, 1.0}} {}
  /// Throws bad_argument when there are no points, when displacements do not start at 0 and rise, when a ratio is not
  /// positive, and when the force, displacement times ratio, falls while the displacement rises; `value` of the error
  /// is that displacement.
  explicit StiffeningCurve(std::vector<Point> points);

  /// O(points), no allocation.
  double ratio(double displacement) const noexcept;

 private:
  [[noreturn]] static void refuse(const std::string& what, double value);

  std::vector<Point> points_;
};

inline StiffeningCurve::StiffeningCurve(std::vector<Point> points) : points_(std::move(points)) {
  if (points_.empty() || points_.front().displacement != 0.0)
    refuse("does not start at a displacement of 0", points_.empty() ? 0.0 : points_.front().displacement);
  for (std::size_t i = 0; i < points_.size(); ++i) {
    const Point& p = points_[i];
    if (!(p.ratio > 0.0 && p.ratio < infinity)) refuse("has the ratio " + number(p.ratio), p.displacement);
    if (i == 0) continue;
    const Point& before = points_[i - 1];
    if (!(p.displacement > before.displacement && p.displacement < infinity))
      refuse("has displacements that do not rise", p.displacement);
    // d(force) / d(displacement) is linear between two points: positive everywhere if positive at both
    const double slope = (p.ratio - before.ratio) / (p.displacement - before.displacement);
    for (const Point& end : {before, p})
      if (!(end.ratio + slope * end.displacement > 0.0)) refuse("has a force that falls", end.displacement);
  }
}

inline double StiffeningCurve::ratio(double displacement) const noexcept {
  if (!(displacement > 0.0)) return points_.front().ratio;
  for (std::size_t i = 1; i < points_.size(); ++i) {
    const Point &a = points_[i - 1], &b = points_[i];
    if (displacement < b.displacement)
      return a.ratio + (displacement - a.displacement) / (b.displacement - a.displacement) * (b.ratio - a.ratio);
  }
  return points_.back().ratio;
}

inline void StiffeningCurve::refuse(const std::string& what, double value) {
  SetupProblem p;
  p.kind = SetupErrorKind::bad_argument;
  p.what = "a stiffening curve " + what + ", at " + number(value) + " m";
  p.hint = "Give points from 0 on with a force that rises";
  p.value = value;
  raise(std::move(p));
}

/// The quasi-non-linear elasticity of Cotin, Delingette and Ayache 1999: the force of the linear tissue is scaled by a
/// curve measured along the direction of pressing (axial) and one measured across it (radial). As a compliance,
///   C'_ij = T C_ij T,   T = n n^T / sqrt(s_axial) + (I - n n^T) / sqrt(s_radial),
/// where n is the direction of the sum of the forces. The compliance stays symmetric and positive, and the contact
/// stays one problem. The ratios follow the force-weighted displacements of the loaded vertices: by half of the
/// difference in each tick, so they converge within a few ticks. Accurate for the measured load cases; elsewhere only
/// as far as the measurement applies (docs/soft.md). Keeps a reference to the tissue. Satisfies TissueModel. Cost: per
/// tick quadratic in the number of loaded vertices; compliances are not reused between ticks while the ratios change.
template <TissueModel Tissue>
class QuasiNonLinear : public TissueAdaptor<Tissue> {
 public:
  QuasiNonLinear(Tissue& tissue, StiffeningCurve axial, StiffeningCurve radial = {})
      : TissueAdaptor<Tissue>(tissue),
        axial_(std::move(axial)),
        radial_(std::move(radial)),
        along_(axial_.ratio(0.0)),
        across_(radial_.ratio(0.0)) {
    set_scale();
  }
  QuasiNonLinear(Tissue&&, StiffeningCurve, StiffeningCurve = {}) = delete;

  TissueClaim& claim() noexcept { return claim_; }
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points = {}) noexcept {
    follow(forces);
    this->tissue().end_tick(forces, points);
  }
  Matrix3 compliance(int i, int j) const noexcept {
    const Matrix3 c = this->tissue().compliance(i, j);
    return scale_ * c * scale_;
  }
  std::uint64_t compliance_revision() const noexcept { return revision_ + this->tissue().compliance_revision(); }
  double compliance_bound(int j) const noexcept {
    return this->tissue().compliance_bound(j) / std::min(along_, across_);
  }
  double compliance_floor() const noexcept { return this->tissue().compliance_floor() / std::max(along_, across_); }

  /// Restores the state after construction.
  void reset() noexcept {
    along_ = axial_.ratio(0.0);
    across_ = radial_.ratio(0.0);
    axis_ = Vector3(0.0, 0.0, 1.0);
    set_scale();
    ++revision_;
  }

  /// Current ratio of the stiffness to that of the linear tissue, along the force and across it.
  double axial_ratio() const noexcept { return along_; }
  double radial_ratio() const noexcept { return across_; }
  /// T, for drawing: displacements are T times those of the linear tissue under forces T f.
  const Matrix3& scale() const noexcept { return scale_; }

 private:
  /// Moves the ratios towards those of the current displacements.
  void follow(std::span<const VertexForce> forces) noexcept {
    Vector3 sum = Vector3::Zero(), moved = Vector3::Zero();
    double weight = 0.0;
    for (const VertexForce& f : forces) sum += f.force.in_model_axes();
    const double total = sum.norm();
    if (!(total > 0.0 && total < infinity)) return update_ratios(axis_, 0.0, 0.0);
    const Vector3 axis = sum / total;
    for (const VertexForce& f : forces) {
      Vector3 u = Vector3::Zero();
      for (const VertexForce& g : forces) u += compliance(f.vertex, g.vertex) * g.force.in_model_axes();
      const double share = std::max(0.0, f.force.in_model_axes().dot(axis));
      moved += share * u;
      weight += share;
    }
    moved /= weight;
    const double along = moved.dot(axis);
    update_ratios(axis, along, (moved - along * axis).norm());
  }
  void update_ratios(const Vector3& axis, double along, double across) noexcept {
    const double next_along = midway(along_, axial_.ratio(along)), next_across = midway(across_, radial_.ratio(across));
    const bool same_axis = along_ == across_ || (axis - axis_).norm() <= imperceptible;
    if (next_along == along_ && next_across == across_ && same_axis) return;
    along_ = next_along;
    across_ = next_across;
    axis_ = axis;
    set_scale();
    ++revision_;
  }
  /// Ignores imperceptible changes, so that a steady contact keeps its compliances.
  static double midway(double now, double wanted) noexcept {
    return std::abs(wanted - now) <= imperceptible * now ? now : 0.5 * (now + wanted);
  }
  void set_scale() noexcept {
    const double b = 1.0 / std::sqrt(across_);
    scale_ = (1.0 / std::sqrt(along_) - b) * axis_ * axis_.transpose();
    for (int c = 0; c < 3; ++c) scale_(c, c) += b;
  }

  static constexpr double imperceptible = 1e-5;  // relative, and radians of the axis

  StiffeningCurve axial_, radial_;
  double along_, across_;
  Vector3 axis_{0.0, 0.0, 1.0};
  Matrix3 scale_;
  std::uint64_t revision_ = 0;
  TissueClaim claim_;
};

/// The static solver `Inner` with a compliance that follows StiffeningCurves; see QuasiNonLinear.
template <class Inner>
struct Stiffening {};

/// Parameters of a model on Stiffening<...>. The default curves leave the tissue linear.
struct StiffeningParameters {
  StiffeningCurve axial{};   ///< along the direction of pressing
  StiffeningCurve radial{};  ///< across it
};

/// Linear static tissue that stiffens: the forces of a tick are those of QuasiNonLinear over the tissue on `Inner`.
/// Functions without tools (loads, report, energies) are those of the linear tissue. Neither copyable nor movable. Base
/// of HapticFEModel on Stiffening<Inner>.
template <class E, class M, class Inner>
class StiffeningTissue : public StaticTissue<E, M, Inner> {
  using Linear = StaticTissue<E, M, Inner>;

 public:
  using Parameters = StiffeningParameters;

  StiffeningTissue(const StiffeningTissue&) = delete;
  StiffeningTissue& operator=(const StiffeningTissue&) = delete;

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

 protected:
  template <MeshOf<E> Given>
  StiffeningTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                   const SetupOptions& options, const Parameters& parameters)
      : Linear(mesh, scene, materials, options), stiffened_(*this, parameters.axial, parameters.radial) {
    scales_.fill(stiffened_.scale());
    scaled_.reserve(3 * largest_default_capacity);
  }

 private:
  void note_scale() noexcept {
    scales_.back() = stiffened_.scale();
    scales_.publish();
  }

  QuasiNonLinear<Linear> stiffened_;
  TripleBuffer<Matrix3> scales_;
  std::vector<VertexForce> scaled_;
};

template <class Inner>
struct SolverTraits<Stiffening<Inner>> {
  static_assert(SolverPolicy<Inner>,
                "palpate: Stiffening scales a static solver, for example Stiffening<Condensed<SelectiveInverse>>");
  template <class E, class M>
  using Tissue = StiffeningTissue<E, M, Inner>;
};

}}  // namespace palpate
