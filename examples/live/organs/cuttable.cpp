// Linear elasticity that can be cut: the compliance follows every cut.
#include <palpate/cut.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/own_types.hpp>

#include "../core/organ_of.hpp"

namespace live {

std::unique_ptr<Organ> make_cuttable(const TouchScene& scene, const Tuning& tuning) {
  using Model = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
  return std::make_unique<OrganOf<Model, false>>(scene, scene.mesh, tuned_conditions(scene, tuning),
                                                 materials_of<LinearElastic>(scene, tuning),
                                                 setup_options(tuning, false));
}

}  // namespace live
