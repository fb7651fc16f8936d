// One method to simulate the scene, and the figures measured of it.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "../common/timing.hpp"
#include "reference.hpp"

namespace tradeoff {

/// A tissue pressed by spheres, simulated tick by tick. Set-up time is the time of the constructor.
class Contender {
 public:
  virtual ~Contender() = default;
  /// Advances one tick. Returns the forces on the spheres [N] for centres at these positions [m].
  virtual std::span<const Vector3> tick(std::span<const Vector3> centres) = 0;
  /// Bound of the error of the force on a sphere in the last tick [N]; infinite: not measured.
  virtual double force_error_bound(std::size_t) const { return infinity; }
  /// Period [s] of update(), which runs in a background thread; 0: no updates.
  virtual double update_period() const { return 0.0; }
  virtual void update() {}
  /// Whether the tissue needs time to come to rest.
  virtual bool has_inertia() const { return false; }
  /// Displacement of the nodes of the given mesh, 3 per node [m]; called after a hold.
  virtual VectorX displacement() = 0;
  /// Relative residual of the method's own equations after a hold: distance of contacts from the sphere, or imbalance
  /// of forces.
  virtual double own_error() = 0;
  /// Relative energy gain (loss: negative) of the body when it is released from its present state and oscillates for a
  /// tenth of a second without damping; NaN for methods without motion.
  virtual double energy_drift() { return std::numeric_limits<double>::quiet_NaN(); }
  virtual Index nodes() const = 0;
  virtual Index kept_dofs() const { return 0; }
  /// Not empty: a remark for the row, for example a degraded model.
  virtual std::string remark() { return {}; }
};

/// Description of a row, before it is measured.
struct Description {
  std::string family{};  ///< condensed, uncondensed, moving, explicit, baseline
  std::string element{}, mesh{}, kinematics{}, solver{}, kept{}, scalar{}, work{};
  std::string paste{};    ///< the composition as C++ code, empty for baselines
  double allowed = 1e-3;  ///< upper bound of own_error
  bool own_core = false;  ///< needs a background thread next to the haptic thread

  std::string name() const;
};

/// A row of the table. Errors are relative; NaN when there is nothing to measure.
struct Row : Description {
  Index nodes = 0, kept_dofs = 0;
  double setup = 0.0, bytes = 0.0;               ///< [s], [bytes] at the peak of set-up
  double p50 = 0.0, p99 = 0.0, worst = 0.0;      ///< time of a tick [s]
  double update_p99 = 0.0, update_period = 0.0;  ///< [s]
  double force_small = 0.0, force_large = 0.0;   ///< force error in holds
  double in_motion = 0.0;  ///< root mean square force error in motion (of the largest force); column "in motion"
  double moved_small = 0.0, moved_large = 0.0;    ///< root mean square displacement error of all nodes
  double volume_small = 0.0, volume_large = 0.0;  ///< error of volume, relative to the volume displaced by the spheres
  double drift = 0.0;
  /// Share of the ticks whose error bar contains the force of the reference, up to the hold at the small depth and of
  /// all, and median of bound over force in the former; NaN: no error bar.
  double bar_small = bench::unknown, bar_all = bench::unknown, bar_size = bench::unknown;
  double own_error = 0.0;
  std::string verdict;  ///< empty: finite, and own_error within its bound
  std::string remark;
};

/// Description and factory of a contender.
struct Entry {
  Description description{};
  std::function<std::unique_ptr<Contender>()> make{};
};

/// Data shared by all contenders.
struct Bench {
  PressScene scene;
  Reference reference;
  Stiffening stiffening;
  Mesh<Tet4> near, all;  ///< refined near the spheres, and everywhere
  bool full = false;

  const Mesh<Tet4>& mesh(const std::string& name) const {
    return name == "near" ? near : name == "all" ? all : scene.mesh;
  }
};

/// Names of meshes for methods with contact at nodes only: includes the refined mesh when the given mesh is so coarse
/// that a sphere fits between its nodes.
std::vector<std::string> meshes_for_node_contact(const Bench& bench);

inline std::string mesh_name(const std::string& mesh) {
  return mesh == "near" ? "refined near" : mesh == "all" ? "refined" : "as given";
}

/// Description of a method used elsewhere, in double; `allowed` is the bound of own_error.
inline Description baseline(const std::string& mesh, const std::string& element, const std::string& kinematics,
                            const std::string& solver, double allowed) {
  return {.family = "baseline",
          .element = element,
          .mesh = mesh_name(mesh),
          .kinematics = kinematics,
          .solver = solver,
          .scalar = "double",
          .allowed = allowed};
}

/// Constructs, runs and evaluates one contender.
Row measure(const Bench& bench, const Entry& entry);

// The families, each in a separate file.
void add_tet4(const Bench& bench, std::vector<Entry>& entries);
void add_tet4_uncondensed(const Bench& bench, std::vector<Entry>& entries);
void add_smoothed(const Bench& bench, std::vector<Entry>& entries);
void add_tet10(const Bench& bench, std::vector<Entry>& entries);
void add_quasi_non_linear(const Bench& bench, std::vector<Entry>& entries);
void add_soft(const Bench& bench, std::vector<Entry>& entries);
void add_quasi_newton(const Bench& bench, std::vector<Entry>& entries);
void add_corotated(const Bench& bench, std::vector<Entry>& entries);
void add_explicit(const Bench& bench, std::vector<Entry>& entries);
void add_springs(const Bench& bench, std::vector<Entry>& entries);
void add_position_based(const Bench& bench, std::vector<Entry>& entries);
void add_plain_eigen(const Bench& bench, std::vector<Entry>& entries);

/// Writes the table as comma-separated values, and as a page with pictures. `budget`: allowed time of a tick [s].
void write_csv(const std::vector<Row>& rows, const std::string& path);
void write_page(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path);
/// The most accurate compositions within the budget, as C++ code to paste.
std::string advice(const std::vector<Row>& rows, double budget);
/// The advice of `suggest` on the scene, with the figures of its candidates.
std::string suggestion(const PressScene& scene, double budget);

}  // namespace tradeoff
