// A tissue of any composition behind one interface.
#pragma once

#include "built.hpp"

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/setup_report.hpp>

#include <memory>
#include <string>
#include <vector>

namespace cross {

struct TissueOptions {
  int threads = 1;
  std::string cache_file{};
  std::string member = "alone";
  palpate::Matrix3 axes = palpate::Matrix3::Identity();  ///< Change::linear: maps the directions of fibres
};

class Tissue {
 public:
  virtual ~Tissue() = default;
  /// A servo on the tissue, on a group of it, or on an adaptor around it, as `member` requests.
  virtual std::unique_ptr<palpate::HapticServo> servo(const palpate::ToolList& tools,
                                                      const palpate::ServoOptions& options) = 0;
  /// Seconds until the next call of work(); 0: there is no background work, or it is done.
  virtual double interval() const = 0;
  virtual void work() = 0;
  virtual std::unique_ptr<palpate::BackgroundWorker> worker() = 0;
  virtual void reset() = 0;
  virtual void set_pose(const Eigen::Isometry3d& pose) = 0;
  /// Other loads and prescribed displacements, for a tissue that moves.
  virtual void set_conditions(const palpate::Scene& conditions) = 0;
  virtual const palpate::SetupReport& report() const = 0;
  /// Orders a cut; false for a tissue that cannot be cut.
  virtual bool cut(const palpate::BladeSweep& sweep) = 0;
  /// Vertices of the contact surface under forces on it, world frame [m]. Requires their columns, as a tick does.
  virtual std::vector<Vector3> surface(std::span<const palpate::VertexForce> forces) = 0;
  /// The longest edge of the facets at each of them [m].
  virtual std::vector<double> facet_lengths() = 0;
};

/// An element, a law and a solver by the words of a scene, and how to make its tissue.
struct Composition {
  std::string element, law, solver;
  /// Throws SetupError. Takes step, inertia and material from the scene; member and threads from the options.
  std::unique_ptr<Tissue> (*make)(const Scene& scene, const Body& body, const TissueOptions& options);
};

/// All that are linked into the program.
const std::vector<Composition>& compositions();
const Composition* find_composition(const std::string& element, const std::string& law, const std::string& solver);

bool moves(const std::string& solver);
bool can_be_cut(const std::string& solver);
/// Whether a solver computes in single precision.
bool has_float(const std::string& solver);

}  // namespace cross
