// Forces that alternate although their devices rest.
#include <palpate/contact/detail/proxy_motion.hpp>

#include <vector>

#include "catch.hpp"

using namespace palpate;

namespace {

/// Whether a tick of a sphere of 5 mm is reported, with these forces [N] and paths of the device [m], one per tick.
std::vector<bool> reported(const std::vector<double>& forces, double path) {
  ProxyMotion motion;
  ContactTool tool;
  tool.radius = 5e-3;
  tool.active = true;
  tool.target = Vector3(0.0, 0.0, 0.1);
  std::vector<bool> result;
  for (const double force : forces) {
    tool.target += Vector3(path, 0.0, 0.0);
    tool.force = Vector3(0.0, 0.1 * force, force);
    result.push_back(motion.end_tick({&tool, 1}, true, true, 1.0));
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
