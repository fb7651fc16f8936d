// A static model whose mesh is refined until the error of its contact forces is small enough.
#pragma once

#include <palpate/element/smoothed.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/detail/accuracy_search.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include <concepts>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// A model, and what was done for its accuracy.
template <class Model>
struct RefinedModel {
  Model model;
  Mesh<Tet4> mesh;  ///< of the model, in the frame of the mesh as given
  Scene scene;      ///< the same scene for that mesh: listed nodes have become groups, for `set_conditions`
  AccuracySearchReport search;
};

/// Makes a static model on a mesh that is refined near the touchable surface until the measured error of the contact
/// force is within the goal, or the goal's budget is used up: look at `search.reached()`, or at
/// SetupFlag::accuracy_not_reached in the report of the model. The scene gives the radius of
/// the sphere that touches (TouchOptions). The first mesh has the edges that sufficed on an organ
/// (AccuracySearch); each further one follows from the errors measured so far. Listed nodes of the scene become groups
/// first, which gain the new nodes between them. Each mesh costs the set-up of a model with `measured_force_error`; one
/// or two are typical. If the set-up on a further mesh fails, for example for lack of memory, the last model is
/// returned; two are in memory meanwhile. The typical error is compared with the goal: single places may have a larger
/// one. `options.force_error` is replaced. For Tet4, Smoothed<Tet4> and Tet10. Throws bad_argument for a goal out of
/// range and for a scene without that radius, and the errors of refine_near and of the model.
template <class Model, class Materials>
RefinedModel<Model> refine_to_accuracy(const Mesh<Tet4>& mesh, const Scene& scene, const Materials& materials,
                                       const AccuracyGoal& goal = {}, SetupOptions options = {}) {
  using E = typename Model::ElementType;
  constexpr bool quadratic = std::same_as<E, Tet10>;
  static_assert(quadratic || std::same_as<E, Tet4> || std::same_as<E, Smoothed<Tet4>>,
                "palpate: refine_to_accuracy divides tetrahedra: choose Tet4, Smoothed<Tet4> or Tet10");
  AccuracySearch search(mesh, scene, goal);
  const auto coarse = search.coarse();
  options.force_error = measured_force_error(goal.places);
  options.force_error.coarse = coarse ? &*coarse : nullptr;
  options.force_error.wanted = goal.error;
  const auto make = [&] {
    if constexpr (quadratic)
      return Model(promote<Tet10>(search.mesh()), search.scene(), materials, options);
    else
      return Model(search.mesh(), search.scene(), materials, options);
  };
  const auto result = [&](Model model) {
    return RefinedModel<Model>{std::move(model), search.mesh(), search.scene(), search.report()};
  };
  RefinedModel<Model> best = result(make());
  while (search.refine(best.model.report().accuracy, best.model.report().total_seconds())) {
#if defined(PALPATE_HAS_EXCEPTIONS)
    try {
      best = result(make());
    } catch (const SetupError& error) {
      if (error.kind() == SetupErrorKind::cancelled) throw;
      best.search = search.report();
      best.search.why_not = std::string("the set-up on a finer mesh failed: ") + error.what();
      return best;
    }
#else
    best = result(make());
#endif
  }
  best.search = search.report();
  return best;
}

}}  // namespace palpate
