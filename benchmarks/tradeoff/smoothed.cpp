// Smoothed linear tetrahedra, which do not lock.
#include <palpate/model/static/refine_to_accuracy.hpp>

#include <cstdio>
#include <sstream>

#include "linear.hpp"

namespace tradeoff {

namespace {

/// The mesh of refine_to_accuracy, with the error bar in every tick; the force is `corrected` by it if asked for.
Entry to_accuracy(const Bench& bench, double error, bool corrected) {
  using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  Entry entry = linear_entry<Smoothed<Tet4>, Condensed<SelectiveInverse>>(
      bench, "Smoothed<Tet4>", "Condensed<SelectiveInverse>", "near", near_group);
  entry.description.mesh = "to " + number(100.0 * error) + (corrected ? " %, corrected" : " %");
  entry.description.paste +=
      "   // refine_to_accuracy<Model>(mesh, scene, materials, {.error = " + number(error) + "}).model";
  if (corrected) entry.description.paste += ", ServoOptions::corrected_force = true";
  entry.make = [&bench, error, corrected] {
    const auto make = [&] {
      Scene scene;
      scene.fix(constrained_group)
          .touch(near_group, {.radius = bench.scene.radius, .pinched = bench.scene.spheres.size() > 1});
      auto refined = refine_to_accuracy<Model>(bench.scene.mesh, scene, bench.scene.materials, {.error = error});
      std::fputs((std::ostringstream() << refined.search).str().c_str(), stdout);
      return std::move(refined.model);
    };
    return std::make_unique<LinearContender<Smoothed<Tet4>, Condensed<SelectiveInverse>>>(bench, make, corrected);
  };
  return entry;
}

}  // namespace

void add_smoothed(const Bench& bench, std::vector<Entry>& entries) {
  using E = Smoothed<Tet4>;
  const char* name = "Smoothed<Tet4>";
  const std::string surface(surface_group);
  for (const std::string& kept : {near_group, wide_group, surface})
    entries.push_back(
        linear_entry<E, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", "given", kept));
  for (const char* mesh : {"near", "all"})
    if (bench.full || mesh == std::string("near"))
      entries.push_back(
          linear_entry<E, Condensed<SelectiveInverse>>(bench, name, "Condensed<SelectiveInverse>", mesh, near_group));
  for (const bool corrected : {true, false}) entries.push_back(to_accuracy(bench, 0.05, corrected));
}

}  // namespace tradeoff
