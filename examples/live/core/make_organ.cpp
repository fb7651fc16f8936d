#include <palpate/model/static/measured_force_error.hpp>

#include "organ_of.hpp"

#include <chrono>
#include <thread>

namespace live {

SetupOptions setup_options(const Tuning& tuning, bool can_measure) {
  SetupOptions options;
  options.threads = static_cast<int>(std::max(2u, std::thread::hardware_concurrency())) - 1;  // one for the ticks
  if (tuning.error_bars && can_measure) options.force_error = measured_force_error(2);        // places: about a second
  return options;
}

Scene tuned_conditions(const TouchScene& scene, const Tuning& tuning) {
  Scene conditions = scene.conditions_at ? scene.conditions_at(0.0) : scene.conditions;
  return tuning.gravity.isZero() ? conditions : conditions.gravity(tuning.gravity);
}

namespace {

std::unique_ptr<Organ> make_any(const TouchScene& scene, Composition composition, const Tuning& tuning) {
  switch (composition) {
    case Composition::tet4:
      return make_tet4(scene, tuning);
    case Composition::smoothed:
      return make_smoothed(scene, tuning);
    case Composition::tet10:
      return make_tet10(scene, tuning);
    case Composition::quasi_newton:
      return make_quasi_newton(scene, tuning);
    case Composition::cuttable:
      return make_cuttable(scene, tuning);
    case Composition::beating:
      return make_beating(scene, tuning);
  }
  raise(SetupErrorKind::bad_argument, "there is no such composition");
}

}  // namespace

std::unique_ptr<Organ> make_organ(const TouchScene& scene, Composition composition, const Tuning& tuning) {
  const auto begin = std::chrono::steady_clock::now();
  std::unique_ptr<Organ> organ = make_any(scene, composition, tuning);
  organ->set_up_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  return organ;
}

}  // namespace live
