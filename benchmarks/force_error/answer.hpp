// Definition of answer().
#pragma once

#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/promote.hpp>

#include <palpate/model/static/measured_force_error.hpp>

#include "press.hpp"

namespace force_error {

template <class E>
auto mesh_for(const Case& test) {
  if constexpr (E::nodes == 8)
    return copy_mesh<E>(test.body.hexahedra(test.facet));
  else if constexpr (E::nodes == 10)
    return promote<E>(tetrahedra_of(test));
  else
    return copy_mesh<E>(tetrahedra_of(test));
}

template <class E>
Answer answer(const Case& test, bool measure) {
  Scene scene;
  scene.fix(test.body.fixed).touch(test.body.touched, {.radius = test.radius});
  const auto mesh = mesh_for<E>(test);
  Answer answer;
  HapticFEModel<E, LinearElastic> model(mesh, scene, materials_of(test));
  answer.setup_seconds = model.report().total_seconds();
  answer.locks = model.report().has(SetupFlag::locking);
  answer.presses = press_all(model, test, {});
  if (!measure) return answer;
  HapticFEModel<E, LinearElastic> measured(mesh, scene, materials_of(test), {.force_error = measured_force_error()});
  answer.measured = press_all(measured, test, {});
  return answer;
}

}  // namespace force_error
