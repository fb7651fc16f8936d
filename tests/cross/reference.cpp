#include "comparisons.hpp"
#include "reference.hpp"

#include <palpate/mesh/generators.hpp>

#include <algorithm>
#include <cmath>

namespace cross {

using namespace palpate;

namespace {

/// Coordinates from `low` to `high`: cells of `fine` within `reach` of `centre`, longer by a half each beyond.
std::vector<double> graded(double low, double high, double centre, double reach, double fine) {
  std::vector<double> x{centre};
  for (const double side : {-1.0, 1.0}) {
    const double limit = side < 0.0 ? centre - low : high - centre;
    double at = 0.0, step = fine;
    std::vector<double> one;
    while (at < limit) {
      at += step;
      one.push_back(std::min(at, limit));
      if (at >= reach) step *= 1.5;
    }
    // A last cell that is much shorter than its neighbour is joined to it.
    if (one.size() > 1 && one.back() - one[one.size() - 2] < 0.4 * step) one.erase(one.end() - 2);
    for (const double d : one) x.push_back(centre + side * d);
  }
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end(), [&](double a, double b) { return b - a < 1e-9 * (high - low); }), x.end());
  x.front() = low, x.back() = high;
  return x;
}

/// Two equal tools at one place from opposite sides.
bool is_equal_pinch(const Scene& s) {
  if (s.tools.size() != 2 || !has_opposite(s)) return false;
  ToolValue other = s.tools[1];
  other.opposite = !other.opposite;
  return other == s.tools[0];
}

double contact_radius(const Scene& s) {
  return std::sqrt(s.tools[0].depth) * s.tools[0].radius;
}

}  // namespace

bool has_reference(const Scene& s) {
  const bool pressed = (s.tools.size() == 1 && !s.tools[0].opposite) || is_equal_pinch(s);
  for (const ToolValue& t : s.tools)
    if ((t.kind != "sphere" && t.kind != "capsule") || t.grasps || (t.path != "press" && t.path != "hold"))
      return false;
  return is_box(s) && pressed && s.law == "linear" && !moves(s.solver) && s.solver != "stiffening" &&
         s.regions == "one" && s.friction == 0.0 && s.load == "none" && s.support_moves == 0.0 && s.cuts == 0 &&
         s.poisson_ratio <= 0.49 && s.tools[0].depth <= 0.5 && s.tools[0].depth >= 0.03;
}

Body reference_body(const Scene& s) {
  const Vector3 size = s.edge * Vector3(s.cells_x, s.cells_y, s.cells_z);
  const Place place = place_of(s, s.tools[0].u, s.tools[0].v, false);
  const double a = contact_radius(s), fine = a / 4.0, reach = 1.3 * a;
  const double half_x = 0.5 * size[0], half_y = 0.5 * size[1];  // boxes are in the middle of x and y: bodies.cpp
  const double length = s.tools[0].kind == "capsule" ? 2.0 * s.tools[0].radius : 0.0;  // of one end
  const bool pinch = s.tools.size() == 2;
  std::vector<double> z = graded(pinch ? 0.5 * size[2] : 0.0, size[2], size[2], reach, fine);
  if (pinch)
    for (std::size_t i = z.size() - 1; i > 0; --i) z.push_back(size[2] - z[i]);
  std::sort(z.begin(), z.end());
  Mesh<Tet4> mesh = box_tet4(graded(-half_x, half_x, place.point[0], reach + length, length > 0.0 ? 3.0 * fine : fine),
                             graded(-half_y, half_y, place.point[1], reach, fine), z);
  Body body;
  if (s.support == "bottom") body.conditions.fix("z0");
  if (s.support != "bottom") body.conditions.fix("x0");
  if (s.support == "sides") body.conditions.fix("x1");
  const Vector3 half = Vector3(2.2 * a + fine + length, 2.2 * a + fine, 0.1 * fine),
                top(place.point[0], place.point[1], size[2]), bottom(place.point[0], place.point[1], 0.0);
  if (pinch)
    body.conditions.touch(where::box(top - half, top + half) || where::box(bottom - half, bottom + half));
  else
    body.conditions.touch(where::box(top - half, top + half));
  body.tetrahedra = std::move(mesh);
  body.tetrahedra.region_names = {"first"};
  body.moduli = {s.youngs_modulus};
  body.density = s.density;
  body.size = size.maxCoeff();
  return body;
}

namespace {

/// What the device gets, if the force is corrected and no limit applies; else the force of the contacts.
const Vector3& given(const Scene& s, const ToolTick& t) {
  const bool limited = t.status.has(StatusFlag::saturated) || t.status.has(StatusFlag::slew_limited);
  return s.corrected && !limited ? t.rendered : t.force;
}

/// That the linear law is beyond its range is true of the reference, too.
Finding count_false_alarms(const Scene& s, const Run& r, const Run& fine) {
  const std::uint32_t alarms = doubts().bits() & ~static_cast<std::uint32_t>(StatusFlag::large_displacement);
  Finding f{false_alarms};
  f.flagged = true;
  for (std::size_t k = 0; k < std::min(r.ticks.size(), fine.ticks.size()); ++k) {
    const ToolTick &a = r.ticks[k][0], &b = fine.ticks[k][0];
    const double right = b.force.norm();
    if (right < 0.2 * fine.peak || (given(s, a) - b.force).norm() > 0.05 * right) continue;
    f.expected += 1.0;
    if ((a.status.bits() & alarms) != 0) f.found += 1.0;
  }
  return f;
}

/// A force is within its own bound or a tenth of the reference, or flagged; a fifth where a support is pressed, since
/// it yields nowhere and both tools sink in between its points.
std::vector<Finding> check_reference(const Scene& s, const Run& r) {
  const Run fine = cross::run(s, {.member = "alone", .pose = "identity", .capacity = 1000, .reference = true});
  if (!r.refused.empty() || !fine.refused.empty()) return {};
  const auto tick = static_cast<std::size_t>(last_hold(s) - 2);
  const ToolTick &a = r.ticks[tick][0], &b = fine.ticks[tick][0];
  const double error = (given(s, a) - b.force).norm(), right = b.force.norm();
  const bool is_bounded = a.bound > 0.0 && std::isfinite(a.bound) && error <= a.bound;
  std::vector<Finding> found{count_false_alarms(s, r, fine)};
  if (error > (presses_support(s) ? 0.2 : 0.1) * right && !is_bounded)
    found.push_back(at("reference", r, static_cast<int>(tick), 0, given(s, a).norm(), right, doubts()));
  return found;
}

}  // namespace

const std::vector<Oracle>& references() {
  static const std::vector<Oracle> all{{"reference", 30, has_reference, check_reference}};
  return all;
}

}  // namespace cross
