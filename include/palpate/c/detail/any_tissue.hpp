// A tissue of any composition behind virtual functions; none of them is called in a tick.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/cut_parameters.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/model_base.hpp>

#include <array>
#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// The drawn surface of a tissue; see VisualSurface.
class Skin {
 public:
  Skin() = default;
  Skin(const Skin&) = delete;
  Skin& operator=(const Skin&) = delete;
  virtual ~Skin() = default;
  virtual bool update() = 0;
  virtual Index point_count() const noexcept = 0;
  virtual const std::vector<std::array<int, 3>>& triangles() const noexcept = 0;
  virtual bool read(std::span<const VertexForce> forces, std::span<float> positions,
                    std::span<float> normals) noexcept = 0;
};

class AnyTissue {
 public:
  AnyTissue() = default;
  AnyTissue(const AnyTissue&) = delete;
  AnyTissue& operator=(const AnyTissue&) = delete;
  virtual ~AnyTissue() = default;

  virtual const SetupReport& report() const noexcept = 0;
  virtual const ModelBase& base() const noexcept = 0;
  /// Displacement under the loads and the forces of tools of the last step, 3 per admitted node [m].
  virtual SolveReport displacement(VectorX& u) noexcept = 0;
  virtual std::unique_ptr<HapticServo> make_servo(const ToolList& tools, const ServoOptions& options) = 0;
  virtual std::unique_ptr<Skin> make_skin() = 0;
  /// Null for a tissue without background work.
  virtual std::unique_ptr<BackgroundWorker> make_worker() = 0;
  /// One piece of background work; false when there was nothing to do.
  virtual bool work() = 0;
  virtual void set_pose(const Eigen::Isometry3d& pose) = 0;
  virtual void set_gravity(const Vector3& gravity) = 0;
  virtual void reset() = 0;
  /// Throws unsupported for a tissue that cannot be cut.
  virtual void cut(const BladeSweep& sweep) = 0;
  /// Nothing for a tissue that cannot be cut.
  virtual std::optional<CutReport> cut_report() = 0;
};

}}}  // namespace palpate::PALPATE_ABI::c_interface
