// Linear elasticity: the smallest ticks. Tet4 locks near nu = 0.5, Smoothed<Tet4> and Tet10 do not.
#include <palpate/mesh/promote.hpp>
#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/elements.hpp>
#include <palpate/palpate.hpp>

#include "../core/organ_of.hpp"

namespace live {

namespace {

template <class E>
using Linear = HapticFEModel<E, LinearElastic, Condensed<SelectiveInverse>>;

template <class E, class M>
std::unique_ptr<Organ> make_linear(const M& mesh, const TouchScene& scene, const Tuning& tuning) {
  return std::make_unique<OrganOf<Linear<E>, true>>(scene, mesh, tuned_conditions(scene, tuning),
                                                    materials_of<LinearElastic>(scene, tuning),
                                                    setup_options(tuning, scene.conditions.touch_radius() > 0.0));
}

}  // namespace

std::unique_ptr<Organ> make_tet4(const TouchScene& scene, const Tuning& tuning) {
  return make_linear<Tet4>(scene.mesh, scene, tuning);
}
std::unique_ptr<Organ> make_smoothed(const TouchScene& scene, const Tuning& tuning) {
  return make_linear<Smoothed<Tet4>>(scene.mesh, scene, tuning);
}
std::unique_ptr<Organ> make_tet10(const TouchScene& scene, const Tuning& tuning) {
  return make_linear<Tet10>(promote<Tet10>(scene.mesh), scene, tuning);
}

}  // namespace live
