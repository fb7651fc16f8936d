// How often a sphere loses the tissue: the same seeded scenes with palpate and with Bullet's deformable bodies, where
// Bullet is installed. Returns 1 if palpate loses the tissue, lets a sphere pass, pulls it in, does not settle or gives
// a force that is not finite.
//   bench_contact_loss [--scenes <number>] [--first <seed>] [--features nodes|faces|both] [--only palpate|bullet]
//                      [--list]
#include "../common/row.hpp"
#include "scenes.hpp"

#include <exception>
#include <map>

namespace contact_loss { namespace {

using Table = std::map<std::string, Counts>;  // by body and by speed

void print(const char* code, const Table& table) {
  for (const auto& [name, c] : table)
    std::printf("%-8s %-22s %6d %6d | %6d %8d %8d %10d %10d %8d\n", code, name.c_str(), c.holds, c.deep, c.lost,
                c.passed, c.inward, c.unsettled, c.not_finite, c.flagged);
}

void note(Table& table, const Scene& scene, const Counts& counts) {
  char speed[32];
  std::snprintf(speed, sizeof speed, "speed %4.2f radii/tick", scene.speed);
  table[scene.body] += counts;
  table[speed] += counts;
  table["~ all"] += counts;
}

void list(const char* code, std::uint64_t seed, const Scene& s, const Counts& c) {
  if (c.failures() == 0) return;
  std::printf(
      "%s, seed %d: %s, E %.3g kPa, radius %.3g mm, depth %.3g mm, speed %g: lost %d, passed %d, inward %d, "
      "unsettled %d, not finite %d\n",
      code, static_cast<int>(seed), s.body.c_str(), 1e-3 * s.material.youngs_modulus, 1e3 * s.radius, 1e3 * s.depth,
      s.speed, c.lost, c.passed, c.inward, c.unsettled, c.not_finite);
}

Features features_of(const std::string& name) {
  return name == "nodes" ? Features::nodes : name == "both" ? Features::both : Features::faces;
}

int run(int argc, char** argv) {
  const int scenes = std::stoi(bench::option(argc, argv, "--scenes", "100"));
  const int first = std::stoi(bench::option(argc, argv, "--first", "1"));
  const Features features = features_of(bench::option(argc, argv, "--features", "faces"));
  const std::string only = bench::option(argc, argv, "--only", "");
  const bool lists = bench::has_option(argc, argv, "--list"), bullet = has_bullet() && only != "palpate";
  if (!has_bullet()) std::puts("Bullet is not installed (apt-get install libbullet-dev): palpate only");
  Table ours, theirs;
  for (int i = 0; i < scenes; ++i) {
    const auto seed = static_cast<std::uint64_t>(first + i);
    const Scene scene = make_scene(seed);
    if (only != "bullet") {
      const Counts counts = run_palpate(scene);
      note(ours, scene, counts);
      if (counts.failures() > 0 || lists) list("palpate", seed, scene, counts);
    }
    if (!bullet) continue;
    const Counts counts = run_bullet(scene, features);
    note(theirs, scene, counts);
    if (lists) list("Bullet", seed, scene, counts);
    std::fflush(stdout);
  }
  std::printf("%-8s %-22s %6s %6s | %6s %8s %8s %10s %10s %8s\n", "code", "scenes", "holds", "deep", "lost", "passed",
              "inward", "unsettled", "not finite", "flagged");
  print("palpate", ours);
  print("Bullet", theirs);
  return ours["~ all"].failures() == 0 ? 0 : 1;
}

}  // namespace
}  // namespace contact_loss

int main(int argc, char** argv) try { return contact_loss::run(argc, argv); } catch (const std::exception& e) {
  std::fprintf(stderr, "bench_contact_loss: %s\n", e.what());
  return 1;
}
