// An organ that can be touched, of any composition.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/setup_report.hpp>

#include "drawn_surface.hpp"
#include "touch_scene.hpp"

#include <memory>

namespace live {

enum class Field { displacement, von_mises };

/// What the window needs of a model, behind virtual functions; none of them is called in a tick.
class Organ {
 public:
  virtual ~Organ() = default;
  virtual const SetupReport& report() const = 0;
  virtual TissueView view() = 0;
  virtual std::unique_ptr<HapticServo> make_servo(const std::vector<Tool>& tools, const ServoOptions& options) = 0;
  virtual void set_gravity(const Vector3& gravity) = 0;  ///< not beside ticks

  /// One piece of background work, for loops in virtual time: every `work_interval` seconds; infinite: there is none.
  virtual double work_interval() const = 0;
  virtual void work() = 0;
  /// The thread that does the same work in real time.
  virtual std::unique_ptr<BackgroundWorker> start_worker() = 0;

  /// The surface under the forces of a snapshot, coloured by a field: displacement where there is no such field. Waits
  /// for a cut in progress. False, with the surface in disorder, where there is none at present. In one thread.
  virtual bool draw(const ServoSnapshot& snapshot, Field field, DrawnSurface& surface) = 0;
  virtual bool has(Field field) const = 0;
  /// Least ratio of an element's volume to its volume at rest; negative: an element is inverted. Not beside `draw`.
  virtual double least_volume_ratio(const ServoSnapshot& snapshot) = 0;
  virtual void write_vtu(const std::string& path, const ServoSnapshot& snapshot) = 0;
  /// Triangles around a region at rest, world frame [m].
  virtual DrawnSurface region(const std::string& name) const = 0;

  double set_up_seconds = 0.0;  ///< wall time of make_organ
};

/// Throws SetupError: what the model refuses.
std::unique_ptr<Organ> make_organ(const TouchScene& scene, Composition composition, const Tuning& tuning);

}  // namespace live
