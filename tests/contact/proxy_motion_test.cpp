// Forces that alternate although their devices rest.
#include <palpate/contact/detail/proxy_motion.hpp>

#include <vector>

#include "catch.hpp"

using namespace palpate;

namespace {

/// Whether a tick of a sphere of 5 mm is reported, with these forces [N], one per tick, and this path of the device
/// [m] in every tick. `noisy`: the path reverses from tick to tick.
std::vector<bool> reported(const std::vector<double>& forces, double path, bool noisy = false) {
  detail::ProxyMotion motion;
  ContactTool tool;
  tool.radius = 5e-3;
  tool.active = true;
  tool.target = Vector3(0.0, 0.0, 0.1);
  std::vector<bool> result;
  for (const double force : forces) {
    tool.target += Vector3(path, 0.0, 0.0);
    if (noisy) path = -path;
    tool.force = Vector3(0.0, 0.1 * force, force);
    result.push_back(motion.end_tick({&tool, 1}, true, force > 0.0, force > 0.0 ? 1.0 : 0.0));
  }
  return result;
}

}  // namespace

TEST_CASE("a force that goes back and forth while its device rests is reported", "[contact][proxy]") {
  using Result = std::vector<bool>;
  CHECK(reported({1.0, 1.02, 1.0, 1.02, 1.0}, 0.0) == Result{false, false, false, true, true});
  CHECK(reported({1.0, 1.02, 1.0, 1.02, 1.0}, 4e-7) == Result{false, false, false, true, true});
  CHECK(reported({1.0, 1.02, 1.0, 1.02, 1.0}, 1e-6) == Result(5, false));   // the device moves
  CHECK(reported({1.0, 1.005, 1.0, 1.005, 1.0}, 0.0) == Result(5, false));  // within the tolerance of the force
  CHECK(reported({1.0, 1.05, 1.1, 1.1, 1.1}, 0.0) == Result(5, false));     // it relaxes or slips, one way
  CHECK(reported({1.0, 0.0, 1.0, 1.0, 1.0}, 0.0) == Result(5, false));      // a tick without a reading
  CHECK(reported({0.0, 1.0, 0.97, 0.97, 0.97}, 0.0) == Result(5, false));   // a slip, and its rebound
  CHECK(reported({0.0, 1e-15, 0.0, 1e-15, 0.0}, 0.0) == Result(5, false));
}

TEST_CASE("a force that goes back and forth while its device moves steadily is reported", "[contact][proxy]") {
  using Result = std::vector<bool>;
  const std::vector<double> forces{1.0, 1.05, 1.0, 1.06, 1.01, 1.07, 1.02};
  CHECK(reported(forces, 1e-4) == Result{false, false, false, false, false, true, true});
  CHECK(reported(forces, 1e-4, true) == Result(7, false));                       // readings with noise
  CHECK(reported({1.0, 1.2, 1.4, 1.35, 1.5, 1.7}, 1e-4) == Result(6, false));    // a slip
  CHECK(reported({1.0, 1.02, 1.0, 1.02, 1.0, 1.02}, 1e-4) == Result(6, false));  // little
}

TEST_CASE("a force that has gone back and forth is reported for some ticks more", "[contact][proxy]") {
  std::vector<double> forces{1.0, 1.02, 1.0, 1.02};
  forces.resize(20, 1.02);
  const std::vector<bool> result = reported(forces, 0.0);
  CHECK(result[3]);
  CHECK(result[9]);
  CHECK_FALSE(result[19]);
  forces.resize(4);
  forces.resize(10, 0.0);
  CHECK(reported(forces, 0.0) ==
        std::vector<bool>{false, false, false, true, false, false, false, false, false, false});
}
