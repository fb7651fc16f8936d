// Scenes of a sphere that presses a body, slides and leaves: the same bodies and paths for every code that is compared.
#pragma once

#include "../common/bodies.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <string>

namespace contact_loss {

using namespace palpate;

inline constexpr double tick = 1e-3;  ///< [s]
inline constexpr int last = 100;      ///< ticks of a hold that are judged

/// A body, all of its boundary touchable, and the path of a sphere over it.
struct Scene {
  std::string body;
  Mesh<Tet4> mesh;
  std::vector<NodeId> constrained;
  std::vector<std::array<NodeId, 3>> surface;  ///< triangles of the boundary, normals outward
  std::vector<std::array<NodeId, 3>> outer;    ///< those that do not bound a cavity
  LinearElastic material{.youngs_modulus = 0.0, .poisson_ratio = 0.4, .density = 1000.0};
  double height = 0.0;  ///< a typical length of the body, for the damping of a motion [m]

  double radius = 0.0, depth = 0.0;    ///< [m]
  double speed = 0.0;                  ///< radii per tick
  Vector3 normal = Vector3::Zero();    ///< outward, where the sphere meets the body; it approaches against it
  std::vector<Vector3> path;           ///< centre of the sphere in every tick [m]
  std::array<std::size_t, 2> holds{};  ///< number of ticks up to the end of each hold

  /// A point above the sphere of a tick, outside the body.
  Vector3 above(std::size_t at) const { return path[at] + (depth + 3.0 * radius) * normal; }
  /// Whether a tick is among the last of a hold.
  bool is_judged(std::size_t at) const {
    return std::ranges::any_of(holds, [&](std::size_t end) { return at < end && at + last >= end; });
  }
  /// Force of a rigid sphere at this depth on a half-space (Hertz 1882) [N].
  double hertz() const;
  /// Whether a point is inside the body at rest: its winding number, from the solid angles of the triangles (Van
  /// Oosterom and Strackee 1983).
  bool contains(const Vector3& point) const;
  /// Whether the straight line between two points crosses the surface displaced by u [m], 3 per node.
  bool crosses(const VectorX& u, const Vector3& from, const Vector3& to) const;
};

/// Scene number `seed`. Bodies: block, plate supported at its four edges, beam clamped at one end, organ-like sphere
/// with a cavity and random nodes. Young's modulus 3 to 100 kPa, radius 1 to 10 mm, depth 0.3 to 3 radii but at most
/// 16 mm (plate 10 mm), speed 0.01 to 3 radii per tick. The path: approach, hold, slide by a radius, hold, leave.
Scene make_scene(std::uint64_t seed);

/// What happened in scenes with one code. Numbers of holds, but for the last two.
struct Counts {
  int holds = 0;
  int deep = 0;        ///< the target of the sphere's centre is inside the body at rest
  int lost = 0;        ///< of those: no contact in some of the last ticks, or less than a thousandth of Hertz' force
  int passed = 0;      ///< tissue is between the sphere and the side from which it came
  int inward = 0;      ///< the mean force points into the tissue
  int unsettled = 0;   ///< the force varies by more than 5 % in the last ticks
  int not_finite = 0;  ///< scenes with a state or force that is not finite
  int flagged = 0;     ///< scenes whose code reported that it did not solve a hold

  int failures() const { return lost + passed + inward + unsettled + not_finite; }
  Counts& operator+=(const Counts& other);
};

/// Collects the forces of a scene and judges its holds.
class Judge {
 public:
  explicit Judge(const Scene& scene) : scene_(scene) { forces_.reserve(scene.path.size()); }

  /// One tick: force on the sphere [N], and whether anything is in contact. False: not finite, stop.
  bool note(const Vector3& force, bool in_contact);
  bool ends_hold() const { return forces_.size() == scene_.holds[0] || forces_.size() == scene_.holds[1]; }
  /// After the last tick of a hold: displacement of all nodes, and the centre of the sphere that is rendered [m].
  void end_hold(const VectorX& u, const Vector3& centre);
  void flag() { counts_.flagged = 1; }
  const Counts& counts() const { return counts_; }

 private:
  const Scene& scene_;
  std::vector<Vector3> forces_;
  int contacts_lost_ = 0;  // consecutive ticks up to now in which contact was lost at most `last` ticks ago
  Counts counts_;
};

Counts run_palpate(const Scene& scene);
/// Which features of Bullet's soft body collide with the sphere.
enum class Features { nodes, faces, both };
bool has_bullet();
Counts run_bullet(const Scene& scene, Features features);

}  // namespace contact_loss
