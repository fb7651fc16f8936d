// One way to feel the scene, and what is measured of it.
#pragma once

#include <functional>
#include <memory>
#include <span>

#include "reference.hpp"

namespace tradeoff {

/// A tissue under spheres, a tick at a time. Made by its constructor, which is what set-up time is.
class Contender {
 public:
  virtual ~Contender() = default;
  /// Forces on the spheres [N] when their centres are there, one tick after the last.
  virtual std::span<const Vector3> tick(std::span<const Vector3> centres) = 0;
  /// What goes on in a thread of its own: seconds between two updates, none with 0.
  virtual double update_period() const { return 0.0; }
  virtual void update() {}
  /// Does it take time to come to rest?
  virtual bool has_inertia() const { return false; }
  /// Of the nodes of the mesh as given [m]; called after a hold.
  virtual VectorX displacement() = 0;
  /// How far the state of a hold is from its own formula, relative: contacts off the sphere, forces out of balance.
  virtual double own_error() = 0;
  /// Share of its energy that the body gains (or loses, negative) when it is let go where it is, and swings for a tenth
  /// of a second without damping; not a number for what does not move.
  virtual double energy_drift() { return std::numeric_limits<double>::quiet_NaN(); }
  /// Sizes.
  virtual Index nodes() const = 0;
  virtual Index kept_dofs() const { return 0; }
  /// Not empty: said of the row, a degraded model for example.
  virtual std::string remark() { return {}; }
};

/// What a row says before it is measured.
struct Description {
  std::string family{};  ///< condensed, uncondensed, moving, explicit, baseline
  std::string element{}, mesh{}, kinematics{}, solver{}, kept{}, scalar{}, work{};
  std::string paste{};    ///< the composition as C++, empty for baselines
  double allowed = 1e-3;  ///< of own_error
  bool own_core = false;  ///< needs a thread beside the one that ticks

  std::string name() const;
};

/// A row of the table. Errors are relative; not a number where there is nothing to measure.
struct Row : Description {
  Index nodes = 0, kept_dofs = 0;
  double setup = 0.0, bytes = 0.0;                ///< [s], at the peak of set-up
  double p50 = 0.0, p99 = 0.0, worst = 0.0;       ///< of a tick [s]
  double update_p99 = 0.0, update_period = 0.0;   ///< [s]
  double force_small = 0.0, force_large = 0.0;    ///< in holds
  double felt = 0.0;                              ///< root mean square in motion, of the largest force
  double moved_small = 0.0, moved_large = 0.0;    ///< displacement of all nodes, root mean square
  double volume_small = 0.0, volume_large = 0.0;  ///< of the volume that the spheres press in
  double drift = 0.0;
  double own_error = 0.0;
  std::string verdict;  ///< empty: finite, and as its own formula says
  std::string remark;
};

/// A way to make a contender.
struct Entry {
  Description description{};
  std::function<std::unique_ptr<Contender>()> make{};
};

/// What all contenders share.
struct Bench {
  PressScene scene;
  Reference reference;
  Stiffening stiffening;
  Mesh<Tet4> near, all;  ///< refined under the spheres, and everywhere
  bool full = false;

  const Mesh<Tet4>& mesh(const std::string& name) const {
    return name == "near" ? near : name == "all" ? all : scene.mesh;
  }
};

/// Names of meshes for what touches with nodes alone: also the refined one where the mesh as given is so coarse that a
/// sphere falls between its nodes.
std::vector<std::string> meshes_for_node_contact(const Bench& bench);

inline std::string mesh_name(const std::string& mesh) {
  return mesh == "near" ? "refined near" : mesh == "all" ? "refined" : "as given";
}

/// What is in use elsewhere, in double; `allowed` of its own error.
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

/// Makes, drives and judges one contender.
Row measure(const Bench& bench, const Entry& entry);

// The families, each in a file of its own.
void add_tet4(const Bench& bench, std::vector<Entry>& entries);
void add_tet4_uncondensed(const Bench& bench, std::vector<Entry>& entries);
void add_smoothed(const Bench& bench, std::vector<Entry>& entries);
void add_tet10(const Bench& bench, std::vector<Entry>& entries);
void add_quasi_non_linear(const Bench& bench, std::vector<Entry>& entries);
void add_soft(const Bench& bench, std::vector<Entry>& entries);
void add_corotated(const Bench& bench, std::vector<Entry>& entries);
void add_explicit(const Bench& bench, std::vector<Entry>& entries);
void add_springs(const Bench& bench, std::vector<Entry>& entries);
void add_position_based(const Bench& bench, std::vector<Entry>& entries);
void add_plain_eigen(const Bench& bench, std::vector<Entry>& entries);

/// The table as comma-separated values, and as a page with pictures. `budget` [s] of a tick.
void write_csv(const std::vector<Row>& rows, const std::string& path);
void write_page(const Bench& bench, const std::vector<Row>& rows, double budget, const std::string& path);
/// The best composition within the budget, ready to paste; empty when there is none.
std::string advice(const std::vector<Row>& rows, double budget);

}  // namespace tradeoff
