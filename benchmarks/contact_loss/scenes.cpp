#include "scenes.hpp"

#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace contact_loss {
namespace {

using testing::Random;

/// The triangles connected with the node of largest x.
std::vector<std::array<NodeId, 3>> outer_part(const Scene& s) {
  std::vector<NodeId> part(s.mesh.positions.size());  // the smallest node of each connected surface
  std::iota(part.begin(), part.end(), 0);
  const auto of = [&](NodeId node) -> NodeId& { return part[static_cast<std::size_t>(node)]; };
  for (bool changed = true; changed;) {
    changed = false;
    for (const auto& t : s.surface) {
      const NodeId least = std::min({of(t[0]), of(t[1]), of(t[2])});
      for (const NodeId node : t) changed = std::exchange(of(node), least) != least || changed;
    }
  }
  const auto far = std::ranges::max_element(s.surface, {}, [&](const auto& t) { return s.mesh.position(t[0]).x(); });
  std::vector<std::array<NodeId, 3>> outer;
  std::ranges::copy_if(s.surface, std::back_inserter(outer), [&](const auto& t) { return of(t[0]) == of((*far)[0]); });
  return outer;
}

/// The mesh of a body and its supports.
void make_body(Scene& s, Random& random) {
  const auto fix = [&](auto wanted) { s.constrained = bench::nodes_where(s.mesh, wanted); };
  constexpr double little = 1e-9;
  switch (random.bits() % 4) {
    case 0:
      s.body = "block";
      s.mesh = box_tet4(Vector3(0.08, 0.08, 0.04), {10, 10, 5}, BoxSplit::six);
      fix([](const Vector3& p) { return p.z() < little; });
      s.height = 0.04;
      break;
    case 1:
      s.body = "plate";
      s.mesh = box_tet4(Vector3(0.1, 0.1, 0.008), {14, 14, 2}, BoxSplit::six);
      fix([](const Vector3& p) { return (p.head<2>().array() - 0.05).abs().maxCoeff() > 0.05 - little; });
      s.height = 0.05;
      break;
    case 2:
      s.body = "beam";
      s.mesh = box_tet4(Vector3(0.08, 0.04, 0.04), {10, 5, 5}, BoxSplit::six);
      fix([](const Vector3& p) { return p.x() < little; });
      s.height = 0.08;
      break;
    default:
      s.body = "organ";
      bench::SupportedBody organ = bench::organ_like(6, 7e-3);
      s.mesh = std::move(organ.mesh);
      s.constrained = std::move(organ.constrained);
      s.height = 0.06;
  }
  for (const BoundaryFace& face : extract_boundary<Tet4>(s.mesh)) {
    std::array<NodeId, 3> t{};
    for (std::size_t i = 0; i < 3; ++i) t[i] = static_cast<NodeId>(face.nodes[i]);
    s.surface.push_back(t);
  }
  s.outer = outer_part(s);
}

Vector3 unit_normal(const Scene& s, const std::array<NodeId, 3>& t) {
  const Vector3 a = s.mesh.position(t[0]);
  return (s.mesh.position(t[1]) - a).cross(s.mesh.position(t[2]) - a).normalized();
}

/// Whether the sphere can press at `point`: no support, edge or side of the body in its reach.
bool is_open(const Scene& s, const Vector3& point, double reach) {
  for (const NodeId i : s.constrained)
    if ((s.mesh.position(i) - point).norm() < reach) return false;
  for (const auto& t : s.outer)
    if (std::abs(unit_normal(s, t).dot(s.normal)) < 0.5)
      for (const NodeId i : t)
        if ((s.mesh.position(i) - point).norm() < reach) return false;
  return true;
}

/// A place on the surface, a sphere and a depth; returns the place.
Vector3 choose_press(Scene& s, Random& random) {
  for (int i = 0;; ++i) {
    if (i % 300 == 0) s.radius = std::exp(random.uniform(std::log(1e-3), std::log(1e-2)));
    s.depth = std::min(random.uniform(0.3, 3.0) * s.radius, s.body == "plate" ? 0.01 : 0.016);
    const auto& t = s.outer[random.bits() % s.outer.size()];
    const double a = random.uniform(), b = random.uniform(0.0, 1.0 - a);
    const Vector3 point = a * s.mesh.position(t[0]) + b * s.mesh.position(t[1]) + (1.0 - a - b) * s.mesh.position(t[2]);
    s.normal = unit_normal(s, t);
    if (is_open(s, point, 2.0 * s.radius + 0.5 * s.depth)) return point;
  }
}

/// Adds the points of a straight line to `end`, steps of at most `step`.
void go_to(std::vector<Vector3>& path, const Vector3& end, double step) {
  const Vector3 start = path.back();
  const int steps = std::max(1, static_cast<int>(std::ceil((end - start).norm() / step)));
  for (int i = 1; i <= steps; ++i) path.emplace_back(start + (end - start) * (static_cast<double>(i) / steps));
}

void make_path(Scene& s, const Vector3& point, Random& random) {
  const double step = s.speed * s.radius;
  const Vector3 pressed = point + (s.radius - s.depth) * s.normal;
  const Vector3 start = point + (1.5 * s.radius + random.uniform() * step) * s.normal;
  Vector3 aside = random.vector<3>(-1.0, 1.0).cross(s.normal);
  aside *= s.radius / aside.norm();
  s.path.assign(5, start);
  go_to(s.path, pressed, step);
  s.path.insert(s.path.end(), 600, pressed);
  s.holds[0] = s.path.size();
  go_to(s.path, pressed + aside, step);
  s.path.insert(s.path.end(), 400, Vector3(pressed + aside));
  s.holds[1] = s.path.size();
  go_to(s.path, start + aside, step);
  s.path.insert(s.path.end(), 20, Vector3(start + aside));
}

}  // namespace

Scene make_scene(std::uint64_t seed) {
  Random random(seed);
  random.bits();
  Scene s;
  make_body(s, random);
  s.material.youngs_modulus = std::exp(random.uniform(std::log(3e3), std::log(1e5)));
  constexpr std::array speeds{0.01, 0.03, 0.1, 0.3, 1.0, 3.0};
  s.speed = speeds[random.bits() % speeds.size()];
  make_path(s, choose_press(s, random), random);
  return s;
}

double Scene::hertz() const {
  const double nu = material.poisson_ratio;
  return 4.0 / 3.0 * material.youngs_modulus / (1.0 - nu * nu) * std::sqrt(radius * depth) * depth;
}

bool Scene::contains(const Vector3& point) const {
  double angle = 0.0;
  for (const auto& t : surface) {
    const Vector3 a = mesh.position(t[0]) - point, b = mesh.position(t[1]) - point, c = mesh.position(t[2]) - point;
    const double la = a.norm(), lb = b.norm(), lc = c.norm();
    angle += 2.0 * std::atan2(a.dot(b.cross(c)), la * lb * lc + a.dot(b) * lc + b.dot(c) * la + c.dot(a) * lb);
  }
  return angle > 2.0 * std::numbers::pi;
}

bool Scene::crosses(const VectorX& u, const Vector3& from, const Vector3& to) const {
  const auto now = [&](NodeId i) { return Vector3(mesh.position(i) + u.segment<3>(3 * Index{i})); };
  const Vector3 d = to - from;
  for (const auto& t : surface) {
    Matrix3 m;
    m << -d, now(t[1]) - now(t[0]), now(t[2]) - now(t[0]);
    if (m.determinant() == 0.0) continue;
    const Vector3 x = m.inverse() * (from - now(t[0]));
    if (x[0] >= 0.0 && x[0] <= 1.0 && x[1] >= 0.0 && x[2] >= 0.0 && x[1] + x[2] <= 1.0) return true;
  }
  return false;
}

Counts& Counts::operator+=(const Counts& o) {
  holds += o.holds, deep += o.deep, lost += o.lost, passed += o.passed, inward += o.inward;
  unsettled += o.unsettled, not_finite += o.not_finite, flagged += o.flagged;
  return *this;
}

bool Judge::note(const Vector3& force, bool in_contact) {
  forces_.push_back(force);
  contacts_lost_ = in_contact ? std::max(0, contacts_lost_ - 1) : last;
  if (!force.allFinite()) counts_.not_finite = 1;
  return force.allFinite();
}

void Judge::end_hold(const VectorX& u, const Vector3& centre) {
  const std::size_t at = forces_.size() - 1;
  Vector3 mean = Vector3::Zero();
  double least = infinity, most = 0.0;
  for (std::size_t i = at + 1 - last; i <= at; ++i) {
    mean += forces_[i] / last;
    least = std::min(least, forces_[i].norm());
    most = std::max(most, forces_[i].norm());
  }
  const bool is_deep = scene_.contains(scene_.path[at]), has_force = mean.norm() > 1e-3 * scene_.hertz();
  counts_.holds += 1;
  counts_.deep += is_deep;
  counts_.lost += is_deep && (!has_force || contacts_lost_ > 0);
  counts_.passed += scene_.crosses(u, centre, scene_.above(at));
  counts_.inward += has_force && mean.dot(scene_.normal) < 0.0;
  counts_.unsettled += has_force && most - least > 0.05 * mean.norm();
}

}  // namespace contact_loss
