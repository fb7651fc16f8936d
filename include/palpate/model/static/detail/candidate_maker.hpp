// Sets up and measures the compositions among which `suggest` chooses.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/static/detail/measure_force_error.hpp>
#include <palpate/model/static/detail/suggested_model.hpp>

#include <cstdint>
#include <functional>
#include <initializer_list>
#include <memory>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// p99 of the processor time of ticks in which the sphere of a servo, made with `rigid_press_options`, presses these
/// points by up to half of its radius [s].
double pressing_tick_seconds(HapticServo& servo, double radius, const std::vector<SurfacePoint>& points);

/// Measures candidates until the time is over. Keeps a reference to the materials.
class SuggestedModelMaker {
 public:
  /// Throws bad_argument.
  SuggestedModelMaker(const Mesh<Tet4>& mesh, const Scene& scene, const RegionMaterials<LinearElastic>& materials,
                      const SuggestBudget& budget);
  SuggestedModelMaker(const SuggestedModelMaker&) = delete;
  SuggestedModelMaker& operator=(const SuggestedModelMaker&) = delete;
  ~SuggestedModelMaker();

  /// Every candidate once. Throws the errors of the set-up of Tet4 on the mesh as given.
  std::vector<SuggestedModel> make_all();
  /// Processor time of this thread since the construction [s].
  double seconds() const noexcept;
  /// Of the time for the suggestion; negative when it is over [s].
  double seconds_left() const noexcept;

 private:
  struct Base;
  /// Set-up times of an element on the finest mesh so far, for predictions.
  struct Cost {
    double nodes = 0.0, touched = 0.0;        // counts
    double of_nodes = 0.0, of_touched = 0.0;  // of its stages [s]
  };
  struct Pending {
    SuggestedModel model;
    double nodes = 0.0, touched = 0.0;
    std::function<void(SuggestedModel&)> measure;
  };

  void make_base(SuggestedModel& model);
  /// Runs `work`; an error becomes the remark.
  template <class Work>
  void attempt(SuggestedModel& model, Work work);
  template <class E>
  Pending pending(const char* element, double edge);
  /// Candidates on refined meshes, in the order in which they are tried.
  std::vector<Pending> refined();
  template <class E>
  void measure(SuggestedModel& model, const Mesh<E>& mesh);
  template <class Tissue>
  void enter(SuggestedModel& model, Tissue& tissue);
  /// Measures it, or leaves it out because of its predicted time.
  void finish(Pending& pending);
  /// Time of its set-up [s].
  double predicted(const Pending& pending) const;
  Cost& cost_of(const std::string& element) noexcept;
  /// The radius divided by each of these, where that is shorter than the facets as given [m].
  std::vector<double> edges(std::initializer_list<double> parts) const;
  /// Cancels what runs longer than this [s], and what runs when the time is over.
  ProgressCallback within(double seconds) const;

  Mesh<Tet4> mesh_;  // without lists of nodes in the scene
  Scene scene_;
  const RegionMaterials<LinearElastic>& materials_;
  SuggestBudget budget_;
  std::int64_t start_;
  std::unique_ptr<Base> base_;
  Cost tet4_, smoothed_, tet10_;
  double too_many_touched_ = infinity;  // touchable nodes with which a tick took clearly longer than the budget
  std::string reference_remark_;        // of the fine tissue, or why it was not made
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/candidate_maker.ipp>
#endif
