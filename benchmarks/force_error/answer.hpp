// Definition of answer().
#pragma once

#include <palpate/element/mean_dilatation.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/mesh/promote.hpp>

#include <palpate/model/static/measured_force_error.hpp>

#include "press.hpp"
#include "recovered_stress.hpp"

namespace force_error {

template <class E>
auto mesh_for(const TestBody& body) {
  if constexpr (E::nodes == 8)
    return copy_mesh<E>(body.hexahedra);
  else if constexpr (E::nodes == 10)
    return promote<E>(body.tetrahedra);
  else
    return copy_mesh<E>(body.tetrahedra);
}

template <class E>
inline constexpr bool has_recovery_estimate = std::same_as<E, Tet4> || std::same_as<E, Tet10>;

template <class E>
Answer answer(const Case& test) {
  Scene scene;
  scene.fix(test.body.fixed).touch(test.body.touched, {.radius = test.radius});
  HapticFEModel<E, LinearElastic> model(mesh_for<E>(test.body), scene, materials_of(test),
                                        {.force_error = measured_force_error()});
  Answer answer;
  answer.presses.resize(test.places.size());
  answer.setup_seconds = model.report().total_seconds();
  const AccuracyReport& accuracy = model.report().accuracy;
  for (const auto& [stage, seconds] : model.report().seconds)
    if (stage == "accuracy") answer.accuracy_seconds = seconds;
  answer.typical = accuracy.typical;
  answer.largest = accuracy.largest;
  answer.remark = accuracy.remark;
  press(model, test, 0, [&](std::size_t i, std::size_t d, const HapticServo& servo, double force) {
    const ForceError error = servo.force_error();
    Press& press = answer.presses[i][d];
    press = {force, error.expected, error.parts.mesh + error.parts.merged, model.report().has(SetupFlag::locking)};
    if constexpr (has_recovery_estimate<E>) press.recovered = recovery_estimate(model, servo);
  });
  answer.nodes_per_element = E::nodes;
  answer.has_recovered = has_recovery_estimate<E>;
  return answer;
}

}  // namespace force_error
