// The guarantees of the force gate over millions of random ticks, including special values.
#include <algorithm>
#include <cfloat>
#include <cmath>
#include <palpate/core/platform.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

constexpr double special_values[] = {0.0,
                                     -0.0,
                                     5e-324,
                                     -5e-324,
                                     DBL_MIN,
                                     1e-310,
                                     1e308,
                                     -1e308,
                                     DBL_MAX,
                                     -DBL_MAX,
                                     infinity,
                                     -infinity,
                                     3.3,
                                     -3.3,
                                     1.0,
                                     1e154,
                                     -1e155,
                                     std::numeric_limits<double>::quiet_NaN(),
                                     -std::numeric_limits<double>::quiet_NaN()};

double special(testing::Random& random) {
  return special_values[random.bits() % std::size(special_values)];
}

/// A component of a force: mostly of typical size, sometimes of any size or special.
double component(testing::Random& random) {
  const double dice = random.uniform();
  if (dice < 0.02) return special(random);
  if (dice < 0.2) return std::copysign(std::pow(10.0, random.uniform(-320.0, 308.0)), random.uniform(-1.0, 1.0));
  return random.uniform(-5.0, 5.0);
}

Vector3 random_force(testing::Random& random) {
  return {component(random), component(random), component(random)};
}

/// The cosine without overflow; 1 where both are zero.
double cosine(const Vector3& a, const Vector3& b) {
  const Vector3 x = a / a.cwiseAbs().maxCoeff(), y = b / b.cwiseAbs().maxCoeff();
  return x.dot(y) / (x.norm() * y.norm());
}

/// Length without overflow.
double length(const Vector3& v) {
  const double largest = v.cwiseAbs().maxCoeff();
  return largest > 0.0 ? largest * (v / largest).norm() : 0.0;
}

struct Input {
  Vector3 wanted;
  double now, stamp;
  bool valid, restart;
};

/// A clock that mostly advances by a millisecond, and sometimes stalls, jumps, stops, runs backwards or is special.
class Source {
 public:
  explicit Source(std::uint64_t seed) : random_(seed) {}
  Input next() {
    const double dice = random_.uniform();
    time_ += dice < 0.9 ? 1e-3 : dice < 0.95 ? random_.uniform(-0.01, 0.05) : dice < 0.97 ? 0.0 : 1e-3;
    if (!(random_.uniform() < 0.95)) faulty_stamp_ = random_.uniform() < 0.5 ? special(random_) : stamp_;
    const bool fresh = random_.uniform() < 0.9;
    if (fresh) stamp_ = time_;
    const double now = random_.uniform() < 0.01 ? special(random_) : time_;
    const double stamp = random_.uniform() < 0.02 ? faulty_stamp_ : stamp_;
    if (random_.uniform() < 0.2) force_ = random_force(random_);
    return {force_, now, stamp, random_.uniform() < 0.99, random_.uniform() < 0.005};
  }
  double uniform(double low, double high) { return random_.uniform(low, high); }

 private:
  testing::Random random_;
  Vector3 force_ = Vector3::Zero();
  double time_ = 0.0, stamp_ = 0.0, faulty_stamp_ = 0.0;
};

struct Count {
  std::int64_t not_finite = 0, above_peak = 0, slew_broken = 0, not_zero = 0, flags_wrong = 0, rotated = 0, at_work = 0;
};

void check_tick(const ForceLimits& limits, const Input& in, const Vector3& before, const GatedForce& out, Count& bad) {
  const bool finite = in.wanted.allFinite();
  const bool emergency = !finite || !in.valid;
  if (!out.force().allFinite() || out.torque() != Vector3::Zero()) ++bad.not_finite;
  if (!(out.force().norm() <= limits.peak_force * (1.0 + 1e-12))) ++bad.above_peak;
  if (out.status.has(StatusFlag::non_finite_force) == finite) ++bad.flags_wrong;
  if (out.status.has(StatusFlag::disconnected) == in.valid) ++bad.flags_wrong;
  if (emergency && out.force() != Vector3::Zero()) ++bad.not_zero;
  if (emergency) return;
  const double most = limits.slew_rate * limits.period;
  if (!((out.force() - before).norm() <= most + 1e-12 * limits.peak_force)) ++bad.slew_broken;
  const double wanted = length(in.wanted);
  if (out.status.has(StatusFlag::saturated) && wanted < limits.peak_force * (1.0 - 1e-12)) ++bad.flags_wrong;
  if (!out.status.has(StatusFlag::saturated) && wanted > limits.peak_force * (1.0 + 1e-12)) ++bad.flags_wrong;
  if (out.force().norm() > 1e-3 * limits.peak_force) ++bad.at_work;
  if (out.status.has(StatusFlag::saturated) && !out.status.has(StatusFlag::slew_limited) && out.force().norm() > 0.0 &&
      !(cosine(out.force(), in.wanted) >= 1.0 - 1e-12))
    ++bad.rotated;
}

Count run(const ForceLimits& limits, std::uint64_t seed, int ticks) {
  Source source(seed);
  ForceGate gate(limits);
  Vector3 before = Vector3::Zero();
  Count bad;
  for (int i = 0; i < ticks; ++i) {
    const Input in = source.next();
    const GatedForce out = gate.apply(in.wanted, in.now, in.stamp, in.valid, in.restart);
    check_tick(limits, in, before, out, bad);
    before = out.force();
  }
  return bad;
}

void check(const Count& bad, int ticks) {
  CHECK(bad.not_finite == 0);
  CHECK(bad.above_peak == 0);
  CHECK(bad.slew_broken == 0);
  CHECK(bad.not_zero == 0);
  CHECK(bad.flags_wrong == 0);
  CHECK(bad.rotated == 0);
  CHECK(bad.at_work > ticks / 20);  // otherwise the gate would be closed most of the time
}

}  // namespace

TEST_CASE("the gate keeps its guarantees over 2e6 random ticks", "[haptic][gate][extreme][D1][D2][D5][D6][D7][D8]") {
  constexpr int ticks = 2'000'000;
  check(run({}, 1, ticks), ticks);
}

TEST_CASE("the gate keeps its guarantees with denormals flushed", "[haptic][gate][extreme][D1][D7]") {
  constexpr int ticks = 500'000;
  const FlushDenormals flush;
  check(run({}, 2, ticks), ticks);
}

TEST_CASE("the gate keeps its guarantees with 200 random limits", "[haptic][gate][extreme][D7][D8]") {
  testing::Random random(3);
  for (int i = 0; i < 200; ++i) {
    ForceLimits limits;
    limits.peak_force = std::pow(10.0, random.uniform(-1.0, 2.0));
    limits.fade_time = random.uniform(0.005, 0.1);
    limits.slew_rate = limits.peak_force / limits.fade_time * std::pow(10.0, random.uniform(0.0, 2.0));
    limits.ramp_time = random.uniform(0.001, 0.2);
    limits.period = random.uniform(0.0002, 0.003);
    limits.stale_after = limits.period * random.uniform(1.5, 10.0);
    INFO("limits " << i);
    Count bad = run(limits, 100u + static_cast<std::uint64_t>(i), 10'000);
    bad.at_work = 10'000;  // with some of the limits this source is always stale
    check(bad, 10'000);
  }
}

TEST_CASE("clamping keeps the direction of 1e6 vectors of every size", "[haptic][gate][extreme][D7]") {
  ForceLimits limits;
  limits.slew_rate = 1e9;  // only the clamp is active
  limits.ramp_time = 1e-9;
  ForceGate gate(limits);
  testing::Random random(4);
  double now = 0.0, worst_cosine = 1.0, longest = 0.0, shortest = 1e9;
  std::int64_t saturated = 0, changed = 0;
  gate.apply(Vector3::Zero(), now, now, true, false);
  for (int i = 0; i < 1'000'000; ++i) {
    const double size = std::pow(10.0, i % 2 == 0 ? random.uniform(-1.0, 2.0) : random.uniform(-320.0, 308.0));
    const Vector3 wanted = random.vector<3>(-1.0, 1.0) * size;
    now += 1e-3;
    const GatedForce out = gate.apply(wanted, now, now, true, false);
    const double wanted_length = length(wanted);
    if (out.status.has(StatusFlag::saturated)) {
      ++saturated;
      worst_cosine = std::min(worst_cosine, cosine(out.force(), wanted));
      longest = std::max(longest, out.force().norm());
      shortest = std::min(shortest, out.force().norm());
    } else if (out.force() != wanted || wanted_length > 3.3 * (1.0 + 1e-12)) {
      ++changed;
    }
  }
  CHECK(saturated > 200'000);
  CHECK(changed == 0);
  CHECK(worst_cosine >= 1.0 - 1e-12);
  CHECK(longest <= 3.3 * (1.0 + 1e-12));
  CHECK(shortest >= 3.3 * (1.0 - 1e-12));
}

TEST_CASE("ramp and fade are monotone for 1000 constant forces", "[haptic][gate][extreme][D3][D5]") {
  testing::Random random(5);
  for (int i = 0; i < 1000; ++i) {
    const Vector3 wanted = random.vector<3>(-1.0, 1.0) * std::pow(10.0, random.uniform(-3.0, 300.0));
    ForceGate gate;
    double before = 0.0;
    int broken = 0;
    for (int k = 0; k < 50; ++k) {
      const double size = gate.apply(wanted, 1e-3 * k, 1e-3 * k, true, false).force().norm();
      if (k == 0 ? size != 0.0 : size < before * (1.0 - 1e-15)) ++broken;
      before = size;
    }
    for (int k = 50; k < 80; ++k) {
      const double size = gate.apply(wanted, 1e-3 * k, 1e-3 * 49, true, false).force().norm();
      if (size > before * (1.0 + 1e-15)) ++broken;
      before = size;
    }
    if (broken > 0 || before != 0.0)
      FAIL("force " << i << ": " << broken << " steps in the wrong direction, ends at " << before);
  }
  SUCCEED();
}
