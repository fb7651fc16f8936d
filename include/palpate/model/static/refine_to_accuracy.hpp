// A static model whose mesh is refined until the error of its contact forces is small enough.
#pragma once

#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include <concepts>
#include <iosfwd>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How accurate contact forces are to be, and what that may cost.
struct AccuracyGoal {
  double error = 0.05;         ///< AccuracyReport::typical that is wanted: relative, 0.001 to 1
  Index most_nodes = 20'000;   ///< of the mesh of linear tetrahedra
  double most_seconds = 30.0;  ///< of set-up: no further mesh is begun that would probably end later [s]
  int places = 3;              ///< of measured_force_error
};

/// A mesh that was tried.
struct AccuracyStep {
  double edge = 0.0;                  ///< wanted at the touchable surface [m]
  Index nodes = 0;                    ///< of the mesh of linear tetrahedra
  double error = 0.0, largest = 0.0;  ///< measured, relative (AccuracyReport)
  double seconds = 0.0;               ///< set-up of the model with the measurement [s]
};

/// What refine_to_accuracy did.
struct AccuracySearchReport {
  double wanted = 0.0;  ///< AccuracyGoal::error
  Index nodes_as_given = 0;
  std::vector<AccuracyStep> steps;  ///< the last one is that of the model
  std::string why_not;              ///< empty when the error is within the wanted one

  bool reached() const noexcept { return why_not.empty(); }
};
std::ostream& operator<<(std::ostream& out, const AccuracySearchReport& r);

/// The meshes of refine_to_accuracy, one after the other. The first edge is 0.28 radii for an error of 5 % and
/// proportional to error^(1/1.75) for others: measured with Smoothed<Tet4> on the shipped organ.
class AccuracySearch {
 public:
  /// Throws bad_argument and the errors of refine_near.
  AccuracySearch(const Mesh<Tet4>& mesh, const Scene& scene, const AccuracyGoal& goal);

  /// The present mesh, and the scene for it.
  const Mesh<Tet4>& mesh() const noexcept { return mesh_; }
  const Scene& scene() const noexcept { return scene_; }
  /// The mesh as given, for ForceErrorOptions::coarse; empty if it has fibres, which a reference does not divide.
  std::optional<MeshRef> coarse() const;
  /// Takes the error measured on the present mesh and the time of that set-up [s]. True: `mesh` is a finer one now.
  bool refine(const AccuracyReport& measured, double seconds);
  const AccuracySearchReport& report() const noexcept { return report_; }

 private:
  bool make_mesh(double edge);
  double next_edge() const;
  bool end(std::string why_not);

  AccuracyGoal goal_;
  Mesh<Tet4> given_, mesh_;
  Scene scene_;
  double edge_ = 0.0;
  bool is_full_ = false;  // a finer mesh would have too many nodes
  AccuracySearchReport report_;
};

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

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/refine_to_accuracy.ipp>
#endif
