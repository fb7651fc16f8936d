// Random presses, slides, pinches and grasps, and what is wrong with their forces. Returns 1 if tissue is swallowed, a
// force without a flag pulls a tool on, a slide ripples by more than 2 % or has a side force of 1 %, jaws with friction
// cross or lose what they pinch, or a grasp fails, changes the force by a tenth or does not rest.
//   bench_presses [--runs <number>] [--only deep|slides|pinches|grasps]
#include "../common/row.hpp"
#include "presses.hpp"

#include <exception>

namespace {

int run(int argc, char** argv) {
  const int runs = std::stoi(bench::option(argc, argv, "--runs", "100"));
  const std::string only = bench::option(argc, argv, "--only", "");
  const auto wanted = [&](const char* part) { return only.empty() || only == part; };
  bool right = true;
  if (wanted("deep")) {
    right = presses::deep_presses(presses::Shape::sphere, 0.0, 6 * runs) && right;
    right = presses::deep_presses(presses::Shape::sphere, 0.3, runs) && right;
    right = presses::deep_presses(presses::Shape::capsule, 0.0, runs) && right;
    right = presses::deep_presses(presses::Shape::box, 0.0, runs) && right;
  }
  if (wanted("slides")) right = presses::slides(std::max(1, runs / 25)) && right;
  if (wanted("pinches")) right = presses::pinches(std::max(1, runs / 50)) && right;
  if (wanted("grasps")) right = presses::grasps(std::max(1, runs / 5)) && right;
  return right ? 0 : 1;
}

}  // namespace

int main(int argc, char** argv) try { return run(argc, argv); } catch (const std::exception& e) {
  std::fprintf(stderr, "bench_presses: %s\n", e.what());
  return 1;
}
