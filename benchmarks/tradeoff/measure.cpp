// How a contender is driven and judged.
#include <palpate/core/platform.hpp>
#include <palpate/haptic/run_haptic_loop.hpp>

#include <algorithm>
#include <numbers>

#include "../common/timing.hpp"
#include "contender.hpp"

namespace tradeoff {
namespace {

constexpr double period = 1e-3;  // of ticks [s]

/// Depth over time: to the small depth, a rest, to the large depth, a rest; then between the two, to and fro, one and a
/// half times, at most 1.65 times as fast.
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

/// A device that asks a thousand times a second, on simulated time: a tick that takes longer than a millisecond leaves
/// the device with the last force meanwhile, and updates come when their thread would have them done.
class Session {
 public:
  Session(const Bench& bench, Contender& contender, bool has_inertia)
      : bench_(bench),
        contender_(contender),
        has_inertia_(has_inertia),
        clock_cost_(palpate::detail::measured_clock_cost()) {
    force_.assign(bench.scene.balls.size(), Vector3::Zero());
  }

  std::vector<double> ticks, updates;  ///< durations in motion [s]
  double squared_error = 0.0;          ///< sum over milliseconds of motion
  int judged = 0;
  bool finite = true;

  const std::vector<Vector3>& force() const noexcept { return force_; }

  /// A millisecond of the device with the balls at a depth.
  void advance(double depth, bool judge) {
    const double period_of_update = contender_.update_period();
    if (period_of_update > 0.0 && time_ >= next_update_) {
      const double spent = timed([&] { contender_.update(); });
      if (judge) updates.push_back(spent);
      // What is published now would have been done by now, had it begun one duration earlier.
      next_update_ = std::max(next_update_ + period_of_update, time_ + spent);
    }
    if (time_ >= next_tick_) {
      const std::vector<Vector3> centres = bench_.scene.centres(depth);
      std::span<const Vector3> answer;
      const double spent = timed([&] { answer = contender_.tick(centres); });
      if (judge) ticks.push_back(spent);
      next_tick_ = judge ? time_ + spent : time_;  // at rest nobody waits
      pending_.assign(answer.begin(), answer.end());
      for (const Vector3& f : pending_) finite = finite && f.allFinite();
    }
    if (!pending_.empty() && next_tick_ <= time_ + period) {  // done within this millisecond
      force_ = pending_;
      pending_.clear();
    }
    if (judge) {
      for (std::size_t b = 0; b < force_.size(); ++b)
        squared_error += (force_[b] - bench_.reference.force(b, depth)).squaredNorm();
      judged += static_cast<int>(force_.size());
    }
    time_ += period;
  }
  /// Rests until the force does for two windows, at most `most` milliseconds and seconds of work. Tissue that has left
  /// the ball is still on its way.
  bool settle(double depth, int most, double seconds) {
    const double start = bench::process_seconds();
    std::vector<Vector3> before = force_;
    int still = 0;
    for (int i = 1; i <= most && bench::process_seconds() - start < seconds; ++i) {
      // Slow updates and ticks are not waited for: each counts for the time it stands for.
      next_tick_ = std::min(next_tick_, time_);
      const double u = contender_.update_period();
      next_update_ = std::min(next_update_, time_ + (u > 0.0 ? u : period));
      advance(depth, false);
      if (i % window() != 0) continue;
      double change = 0.0, size = 0.0;
      for (std::size_t b = 0; b < force_.size(); ++b) {
        change = std::max(change, (force_[b] - before[b]).norm());
        size = std::max(size, force_[b].norm());
      }
      before = force_;
      still = size > 0.0 && change <= 2e-4 * size ? still + 1 : 0;
      if (still == 2) return true;
    }
    return false;
  }

 private:
  /// Milliseconds over which a force at rest must stand still.
  int window() const noexcept {
    if (!has_inertia_) return 4;
    const double u = contender_.update_period();
    return std::max(40, static_cast<int>(std::ceil(3.0 * u / period)));
  }
  template <class Work>
  double timed(Work&& work) const {
    const std::int64_t start = platform::compute_ns();
    work();
    return std::max(0.0, 1e-9 * static_cast<double>(platform::compute_ns() - start) - clock_cost_);
  }

  const Bench& bench_;
  Contender& contender_;
  bool has_inertia_;
  double clock_cost_;
  double time_ = 0.0, next_tick_ = 0.0, next_update_ = 0.0;
  std::vector<Vector3> force_, pending_;
};

double force_error(const Bench& bench, const std::vector<Vector3>& force, double depth) {
  double off = 0.0, size = 0.0;
  for (std::size_t b = 0; b < force.size(); ++b) {
    const Vector3 right = bench.reference.force(b, depth);
    off += (force[b] - right).squaredNorm();
    size += right.squaredNorm();
  }
  return std::sqrt(off / size);
}

/// Volume that the balls press in, were the surface flat.
double pressed_volume(const PressScene& scene, double depth) {
  const double d = std::min(depth, scene.radius);
  return static_cast<double>(scene.balls.size()) * std::numbers::pi * d * d * (scene.radius - d / 3.0);
}

struct HoldErrors {
  double moved, volume;
};
HoldErrors judge_hold(const Bench& bench, const VectorX& u, const VectorX& right, double volume, double depth) {
  const auto boundary = boundary_triangles(bench.scene.mesh);
  return {(u - right).norm() / right.norm(),
          std::abs(volume_of(bench.scene.mesh, boundary, u) - volume) / pressed_volume(bench.scene, depth)};
}

void judge(const Bench& bench, Contender& contender, Row& row) {
  const PressScene& scene = bench.scene;
  const Motion motion{scene.small, scene.large, scene.speed};
  const bool has_inertia =
      row.family == "moving" || row.family == "explicit" || row.element == "mass-spring" || row.element == "XPBD";
  Session session(bench, contender, has_inertia);
  double time = 0.0;
  const auto follow = [&](double until) {
    for (; time < until; time += period) session.advance(motion.depth(time), true);
  };
  const double patience = bench.full ? 120.0 : 12.0;  // [s] of work per hold
  std::string unsettled;
  const auto hold = [&](double depth, const VectorX& right, double volume, double& force, double& moved,
                        double& change) {
    if (!session.settle(depth, 4000, patience)) unsettled = "DID NOT COME TO REST at " + number(1e3 * depth) + " mm";
    force = force_error(bench, session.force(), depth);
    const HoldErrors errors = judge_hold(bench, contender.displacement(), right, volume, depth);
    moved = errors.moved;
    change = errors.volume;
    row.own_error = std::max(row.own_error, contender.own_error());
  };
  const Reference& r = bench.reference;
  follow(motion.leave_small());
  hold(scene.small, r.displacement_small, r.volume_small, row.force_small, row.moved_small, row.volume_small);
  follow(motion.leave_large());
  hold(scene.large, r.displacement_large, r.volume_large, row.force_large, row.moved_large, row.volume_large);
  row.drift = contender.energy_drift();
  follow(motion.end());

  double largest = 0.0;
  for (std::size_t b = 0; b < scene.balls.size(); ++b) largest = std::max(largest, r.force(b, scene.large).norm());
  row.felt = std::sqrt(session.squared_error / session.judged) / largest;
  row.p50 = bench::percentile(session.ticks, 0.5);
  row.p99 = bench::percentile(session.ticks, 0.99);
  row.worst = std::ranges::max(session.ticks);
  row.remark = contender.remark();
  if (!session.updates.empty()) {
    row.update_p99 = bench::percentile(session.updates, 0.99);
    row.update_period = contender.update_period();
    if (const double usual = bench::percentile(session.updates, 0.5); usual > row.update_period)
      row.remark += (row.remark.empty() ? "" : "; ") +
                    ("slow motion: " + number(std::round(1e3 * usual)) + " ms for " + number(1e3 * row.update_period));
  }
  const bool finite = session.finite && std::isfinite(row.felt) && std::isfinite(row.force_small) &&
                      std::isfinite(row.force_large) && std::isfinite(row.moved_small) &&
                      std::isfinite(row.moved_large);
  if (!finite)
    row.verdict = "NOT FINITE";
  else if (!unsettled.empty())
    row.verdict = unsettled;
  else if (!(row.own_error <= row.allowed))
    row.verdict = "OFF ITS OWN FORMULA by " + number(row.own_error);
}

}  // namespace

std::string Description::name() const {
  std::string text = element;
  for (const std::string* part : {&mesh, &kinematics, &solver, &kept, &scalar, &work})
    if (!part->empty()) text += ", " + *part;
  return text;
}

Row measure(const Bench& bench, const Entry& entry) {
  Row row;
  static_cast<Description&>(row) = entry.description;
  try {
    std::unique_ptr<Contender> contender;
    row.bytes = bench::peak_growth([&] { row.setup = bench::seconds_of([&] { contender = entry.make(); }); });
    row.nodes = contender->nodes();
    row.kept_dofs = contender->kept_dofs();
    judge(bench, *contender, row);
  } catch (const SetupError& refused) {
    row.verdict = std::string("REFUSED: ") + refused.what();
    row.p99 = row.felt = row.force_small = row.force_large = bench::unknown;
  }
  return row;
}

}  // namespace tradeoff
