// Runs and evaluates a contender.
#include <algorithm>
#include <numbers>

#include "../common/timing.hpp"
#include "page.hpp"
#include "session.hpp"

namespace tradeoff {
namespace {

/// Depth over time: to the small depth, a rest, to the large depth, a rest; then one and a half oscillations between
/// the two, at most 1.65 times as fast.
struct Motion {
  double small, large, speed;
  static constexpr double rest = 0.15;

  double down_small() const { return small / speed; }
  double leave_small() const { return down_small() + rest; }
  double down_large() const { return leave_small() + (large - small) / speed; }
  double leave_large() const { return down_large() + rest; }
  double swing_frequency() const { return 1.65 * speed / (std::numbers::pi * (large - small)); }
  double end() const { return leave_large() + 1.5 / swing_frequency(); }
  double depth(double t) const {
    if (t < down_small()) return speed * t;
    if (t < leave_small()) return small;
    if (t < down_large()) return small + speed * (t - leave_small());
    if (t < leave_large()) return large;
    return small +
           0.5 * (large - small) * (1.0 + std::cos(2.0 * std::numbers::pi * swing_frequency() * (t - leave_large())));
  }
};

double force_error(const Bench& bench, const std::vector<Vector3>& force, double depth) {
  double difference = 0.0, size = 0.0;
  for (std::size_t b = 0; b < force.size(); ++b) {
    const Vector3 right = bench.reference.force(b, depth);
    difference += (force[b] - right).squaredNorm();
    size += right.squaredNorm();
  }
  return std::sqrt(difference / size);
}

/// Volume that the spheres displace [m^3], for a flat surface.
double pressed_volume(const PressScene& scene, double depth) {
  const double d = std::min(depth, scene.radius);
  return static_cast<double>(scene.spheres.size()) * std::numbers::pi * d * d * (scene.radius - d / 3.0);
}

struct HoldErrors {
  double moved, volume;
};
HoldErrors errors_of_hold(const Bench& bench, const VectorX& u, const VectorX& right, double volume, double depth) {
  const auto boundary = boundary_triangles(bench.scene.mesh);
  return {(u - right).norm() / right.norm(),
          std::abs(volume_of(bench.scene.mesh, boundary, u) - volume) / pressed_volume(bench.scene, depth)};
}

void evaluate(const Bench& bench, Contender& contender, Row& row) {
  const PressScene& scene = bench.scene;
  const Motion motion{scene.small, scene.large, scene.speed};
  Session session(bench, contender);
  double time = 0.0;
  const auto follow = [&](double until) {
    for (; time < until; time += period) session.advance(motion.depth(time), true);
  };
  const double patience = bench.full ? 120.0 : 12.0;  // [s] of work per hold
  std::string unsettled;
  const auto hold = [&](double depth, const VectorX& right, double volume, double& force, double& moved,
                        double& change) {
    const Session::Rest rest = session.settle(depth, 4000, patience);
    if (rest != Session::Rest::reached)
      unsettled = (rest == Session::Rest::lost ? "LOST THE TISSUE at " : "DID NOT COME TO REST at ") +
                  number(1e3 * depth) + " mm";
    force = force_error(bench, session.force(), depth);
    const HoldErrors errors = errors_of_hold(bench, contender.displacement(), right, volume, depth);
    moved = errors.moved;
    change = errors.volume;
    row.own_error = std::max(row.own_error, contender.own_error());
  };
  const Reference& r = bench.reference;
  follow(motion.leave_small());
  if (session.barred > 0) {
    row.bar_small = static_cast<double>(session.contained) / session.barred;
    row.bar_size = bench::percentile(session.bars, 0.5);
  }
  hold(scene.small, r.displacement_small, r.volume_small, row.force_small, row.moved_small, row.volume_small);
  follow(motion.leave_large());
  hold(scene.large, r.displacement_large, r.volume_large, row.force_large, row.moved_large, row.volume_large);
  row.drift = contender.energy_drift();
  follow(motion.end());

  double largest = 0.0;
  for (std::size_t b = 0; b < scene.spheres.size(); ++b) largest = std::max(largest, r.force(b, scene.large).norm());
  row.in_motion = std::sqrt(session.squared_error / session.samples) / largest;
  row.p50 = bench::percentile(session.ticks, 0.5);
  row.p99 = bench::percentile(session.ticks, 0.99);
  row.worst = std::ranges::max(session.ticks);
  row.remark = contender.remark();
  if (session.barred > 0) {
    row.bar_all = static_cast<double>(session.contained) / session.barred;
    row.remark += (row.remark.empty() ? "" : "; ") +
                  ("error bar of " + percent(row.bar_size) + " % contains the reference in " + percent(row.bar_small) +
                   " % of the ticks at the small depth, " + percent(row.bar_all) + " % of all");
  }
  if (!session.updates.empty()) {
    row.update_p99 = bench::percentile(session.updates, 0.99);
    row.update_period = contender.update_period();
    if (const double median = bench::percentile(session.updates, 0.5); median > row.update_period)
      row.remark += (row.remark.empty() ? "" : "; ") + ("slower than real time: " + three_digits(1e3 * median) +
                                                        " ms for " + three_digits(1e3 * row.update_period));
  }
  const bool finite = session.finite && std::isfinite(row.in_motion) && std::isfinite(row.force_small) &&
                      std::isfinite(row.force_large) && std::isfinite(row.moved_small) &&
                      std::isfinite(row.moved_large);
  if (!finite)
    row.verdict = "NOT FINITE";
  else if (!unsettled.empty())
    row.verdict = unsettled;
  else if (!(row.own_error <= row.allowed))
    row.verdict = "OWN CHECK FAILED: " + three_digits(row.own_error);
}

}  // namespace

std::string Description::name() const {
  std::string text = element;
  for (const std::string* part : {&mesh, &kinematics, &solver, &kept, &scalar, &work})
    if (!part->empty()) text += ", " + *part;
  return text;
}

std::vector<std::string> meshes_for_node_contact(const Bench& bench) {
  constexpr int enough = 6;  // nodes within a radius of the first contact point of a sphere
  const Mesh<Tet4>& mesh = bench.scene.mesh;
  for (const Sphere& sphere : bench.scene.spheres)
    if (std::ranges::count_if(mesh.find_group(near_group)->nodes, [&](NodeId node) {
          return (mesh.position(node) - sphere.point).norm() < bench.scene.radius;
        }) < enough)
      return {"given", "near"};
  return {"given"};
}

Row measure(const Bench& bench, const Entry& entry) {
  Row row;
  static_cast<Description&>(row) = entry.description;
  try {
    std::unique_ptr<Contender> contender;
    row.bytes = bench::peak_growth([&] { row.setup = bench::seconds_of([&] { contender = entry.make(); }); });
    row.nodes = contender->nodes();
    row.kept_dofs = contender->kept_dofs();
    evaluate(bench, *contender, row);
  } catch (const SetupError& refused) {
    row.verdict = std::string("REFUSED: ") + refused.what();
    row.p99 = row.in_motion = row.force_small = row.force_large = bench::unknown;
  }
  return row;
}

}  // namespace tradeoff
