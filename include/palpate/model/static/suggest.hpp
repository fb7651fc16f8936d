// Advice before a model is made: the element and the mesh for linear tissue that a tool presses, within a budget.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/refine_near.hpp>  // for the suggested code
#include <palpate/mesh/scene.hpp>
#include <palpate/model/static/detail/suggested_model.hpp>

#include <optional>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The advice of `suggest`.
struct Suggestion {
  std::vector<detail::SuggestedModel> candidates;
  std::optional<std::size_t> chosen;  ///< empty: none is within the tick and the set-up of the budget
  bool within_error = false;          ///< whether the chosen one has the wanted error
  std::string reason;                 ///< one sentence
  bool lists_nodes = false;           ///< whether the scene does: they become groups first
  double seconds = 0.0;               ///< processor time that the suggestion took

  /// C++ code that makes the chosen model of `mesh`, `scene` and `material`; a comment when none is chosen.
  std::string code() const;
};

/// Which of Tet4, Smoothed<Tet4> and Tet10 on the mesh as given, and Smoothed<Tet4> and Tet10 on meshes refined near
/// the touchable part, presses most accurately within the budget on this machine. Each is set up, pressed at the same
/// points as one tissue on a fine mesh (detail/measure_force_error.hpp), and its ticks are timed; one whose set-up is
/// predicted to exceed the budget by far is left out. Their largest errors are compared: the error of coarse facets
/// depends on where they are pressed, and typical ones of a few points rank them too high. If an error is wanted, the
/// one with the shortest set-up among those with that error is chosen; else, and if none has it, that with the least
/// error. Loads and prescribed
/// displacements of the scene are left out: the tool presses the body at rest. Listed nodes become groups first.
///
/// Valid for tools that press; what lifts or pulls a part needs large strain (docs/choosing.md). Throws bad_argument
/// for a budget out of range, or a scene without the radius of the tool (TouchOptions); the errors of a set-up.
Suggestion suggest(const Mesh<Tet4>& mesh, const Scene& scene, const RegionMaterials<LinearElastic>& materials,
                   const detail::SuggestBudget& budget = {});
Suggestion suggest(const Mesh<Tet4>& mesh, const Scene& scene, const LinearElastic& material,
                   const detail::SuggestBudget& budget = {});

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/suggest.ipp>
#endif
