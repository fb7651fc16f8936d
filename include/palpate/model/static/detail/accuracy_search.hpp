// Finds a mesh on which contact forces are accurate enough.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/accuracy_report.hpp>

#include <iosfwd>
#include <optional>
#include <string>
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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/accuracy_search.ipp>
#endif
