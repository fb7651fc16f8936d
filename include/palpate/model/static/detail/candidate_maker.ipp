// Definitions of candidate_maker.hpp.
#pragma once

#include <palpate/model/static/detail/candidate_maker.hpp>

#include <palpate/core/platform.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <type_traits>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The supports and the touchable part of a scene, without its loads.
inline Scene scene_at_rest(const Scene& scene) {
  Scene rest;
  for (const auto& [where, values] : scene.prescribed()) {
    Components zero{};
    for (std::size_t c = 0; c < 3; ++c)
      if (values[c]) zero[c] = 0.0;
    rest.prescribe(where, zero);
  }
  for (const Selection& part : scene.touched())
    rest.touch(part, {.radius = scene.touch_radius(), .pinched = scene.is_pinched()});
  return rest;
}

/// A model whose body and supports can be measured.
class PressableTissue : public HapticFEModel<Tet4, LinearElastic> {
 public:
  using HapticFEModel::HapticFEModel;

  ForceErrorSource source(int places) {
    conditions_ = elastic_body().conditions(scene());
    return {elastic_body(),
            conditions_,
            touchable_nodes(),
            contact_surface(),
            to_world().translation(),
            scene().touch_radius(),
            scene().is_pinched(),
            places,
            node_map(),
            nullptr};
  }

 private:
  EssentialConditions conditions_;
};

PALPATE_INLINE double pressing_tick_seconds(HapticServo& servo, double radius,
                                            const std::vector<SurfacePoint>& points) {
  constexpr int ticks = 600, rounds = 2;
  constexpr double two_pi = 6.283185307179586, waves = 1.0;
  double best = infinity;  // of the rounds: other programs only make ticks longer
  std::vector<std::int64_t> times;
  times.reserve(ticks);
  for (int round = 0; round < rounds; ++round) {
    times.clear();
    servo.reset();
    ToolState state;
    for (int i = 0; i < ticks; ++i) {
      const SurfacePoint& point = points[static_cast<std::size_t>(i) * points.size() / ticks];
      const double wave = waves * i * static_cast<double>(points.size()) / ticks;
      const double depth = radius * (0.2 - 0.3 * std::cos(two_pi * wave));
      state.time += 1e-3;
      state.position = point.position + (radius - depth) * point.outward;
      const std::int64_t before = platform::compute_ns();
      servo.tick(state);
      times.push_back(platform::compute_ns() - before);
    }
    const auto p99 = times.begin() + ticks * 99 / 100;
    std::nth_element(times.begin(), p99, times.end());
    best = std::min(best, 1e-9 * static_cast<double>(*p99));
  }
  return best;
}

/// The model of Tet4 on the mesh as given, and the errors measured from it.
struct SuggestedModelMaker::Base {
  PressableTissue tissue;
  ForceErrorMeasurement errors;

  Base(const Mesh<Tet4>& mesh, const Scene& scene, const RegionMaterials<LinearElastic>& materials, int places,
       const SetupOptions& options)
      : tissue(mesh, scene, materials, options), errors(tissue.source(places)) {}
};

PALPATE_INLINE SuggestedModelMaker::SuggestedModelMaker(const Mesh<Tet4>& mesh, const Scene& scene,
                                                        const RegionMaterials<LinearElastic>& materials,
                                                        const SuggestBudget& budget)
    : mesh_(mesh),
      scene_(name_listed_nodes(mesh_, scene_at_rest(scene))),
      materials_(materials),
      budget_(budget),
      start_(platform::compute_ns()) {
  const auto require = [](bool good, const char* what) {
    if (!good) raise(SetupErrorKind::bad_argument, std::string(what) + " of the budget is out of range");
  };
  require(budget.tick_seconds > 0.0, "the time of a tick");
  require(budget.setup_seconds > 0.0, "the time of the set-up");
  require(budget.error >= 0.0, "the error");
  require(budget.seconds > 0.0, "the time for the suggestion");
  require(budget.places > 0, "the number of places");
  if (!(scene.touch_radius() > 0.0))
    raise(SetupErrorKind::bad_argument, "the scene does not give the radius of the tool",
          "Give it: touch(where, {.radius = 4e-3})");
}

PALPATE_INLINE SuggestedModelMaker::~SuggestedModelMaker() = default;

PALPATE_INLINE double SuggestedModelMaker::seconds() const noexcept {
  return 1e-9 * static_cast<double>(platform::compute_ns() - start_);
}

PALPATE_INLINE double SuggestedModelMaker::seconds_left() const noexcept {
  constexpr double used = 0.97;  // of the budget: a set-up ends some time after it is cancelled
  return used * budget_.seconds - seconds();
}

PALPATE_INLINE ProgressCallback SuggestedModelMaker::within(double most) const {
#if defined(PALPATE_HAS_EXCEPTIONS)
  const double end = seconds() + std::min(most, seconds_left());
  return [this, end](const Progress&) { return seconds() < end; };
#else
  (void)most;
  return {};
#endif
}

template <class Tissue>
void SuggestedModelMaker::enter(SuggestedModel& model, Tissue& tissue) {
  constexpr double clearly = 1.2;
  const SetupReport& report = tissue.report();
  model.nodes = report.nodes;
  model.kept_dofs = report.kept_dofs;
  model.bytes = report.stiffness_bytes + report.solver_bytes + report.compliance_bytes;
  if (Cost& cost = cost_of(model.element); cost.nodes < static_cast<double>(model.nodes)) {
    cost = {};
    cost.nodes = static_cast<double>(model.nodes);
    cost.touched = static_cast<double>(tissue.touchable_nodes().size());
    const double busy = std::min(1.0, model.setup / report.total_seconds());  // processor time per time of the stages
    for (const auto& [stage, time] : report.seconds)
      (stage == "condensation" || stage == "compliance" ? cost.of_touched : cost.of_nodes) += busy * time;
  }
  const TissueView view(tissue);
  HapticServo servo(tissue, SphereTool{scene_.touch_radius()}, rigid_press_options(0));
  model.tick = pressing_tick_seconds(servo, scene_.touch_radius(), base_->errors.points());
  if (model.tick > clearly * budget_.tick_seconds)
    too_many_touched_ = std::min(too_many_touched_, static_cast<double>(tissue.touchable_nodes().size()));
  if (!reference_remark_.empty()) {
    model.remark = reference_remark_;
    return;
  }
  const AccuracyReport errors = base_->errors.compared(view);
  model.error = errors.typical;
  model.largest = std::abs(errors.largest);
  model.measured = true;
}

/// Tet4 on the mesh as given, and the fine tissue.
PALPATE_INLINE void SuggestedModelMaker::make_base(SuggestedModel& model) {
  const double before = seconds();
  base_ = std::make_unique<Base>(mesh_, scene_, materials_, budget_.places, SetupOptions{});
  model.setup = seconds() - before;
  if (base_->errors.is_possible()) {
    const TissueView view(base_->tissue);
    base_->errors.press_given(view);
#if defined(PALPATE_HAS_EXCEPTIONS)
    try {
      base_->errors.press_reference({.progress = within(budget_.seconds)});
    } catch (const SetupError& error) {
      if (error.kind() != SetupErrorKind::cancelled) throw;
      reference_remark_ = "the tissue on a fine mesh, for comparison, takes longer than the suggestion may";
    }
#else
    base_->errors.press_reference({});
#endif
  }
  if (reference_remark_.empty()) reference_remark_ = base_->errors.report().remark;
  if (base_->errors.is_possible()) enter(model, base_->tissue);
  model.remark = reference_remark_;
}

template <class E>
void SuggestedModelMaker::measure(SuggestedModel& model, const Mesh<E>& mesh) {
  using Model = HapticFEModel<std::conditional_t<std::same_as<E, Tet4>, Smoothed<Tet4>, E>, LinearElastic>;
  const double before = seconds();
  Model tissue(mesh, scene_, materials_, SetupOptions{.progress = within(budget_.setup_seconds)});
  model.setup += seconds() - before;
  enter(model, tissue);
}

PALPATE_INLINE SuggestedModelMaker::Cost& SuggestedModelMaker::cost_of(const std::string& element) noexcept {
  return element == "Tet4" ? tet4_ : element == "Tet10" ? tet10_ : smoothed_;
}

/// Elimination in three dimensions grows with the square of the nodes; storing the compliance of the touchable ones
/// with the square of their number, eliminating it with the cube: between them. Tet10 is about as sparse as Tet4.
PALPATE_INLINE double SuggestedModelMaker::predicted(const Pending& p) const {
  const Cost& known = p.model.element != "Tet10" ? smoothed_ : tet10_.nodes > 0.0 ? tet10_ : tet4_;
  if (!(known.nodes > 0.0)) return p.model.setup;
  return p.model.setup + known.of_nodes * std::pow(p.nodes / known.nodes, 2.0) +
         known.of_touched * std::pow(p.touched / known.touched, 2.5);
}

template <class Work>
void SuggestedModelMaker::attempt(SuggestedModel& model, Work work) {
  const double before = seconds();
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    work();
  } catch (const SetupError& error) {
    model.setup = seconds() - before;
    model.remark = error.kind() != SetupErrorKind::cancelled ? error.what()
                   : seconds_left() > 0.0                    ? "its set-up takes longer than the budget"
                                                             : "the time for the suggestion is over";
  }
#else
  work();
#endif
}

/// A candidate with its mesh, E: Tet4 for Smoothed<Tet4>.
template <class E>
SuggestedModelMaker::Pending SuggestedModelMaker::pending(const char* element, double edge) {
  constexpr Index most_nodes_factor = 20, least_most_nodes = 20000;
  Pending p;
  p.model.element = element;
  p.model.edge = edge;
  attempt(p.model, [&] {
    const double before = seconds();
    Mesh<Tet4> near_mesh = mesh_;
    if (edge > 0.0)
      near_mesh = refine_near_touched(
          mesh_, scene_, edge, {.most_nodes = std::max(most_nodes_factor * mesh_.node_count(), least_most_nodes)});
    Mesh<E> mesh;
    if constexpr (std::same_as<E, Tet10>)
      mesh = promote<Tet10>(near_mesh);
    else
      mesh = std::move(near_mesh);
    p.model.setup = seconds() - before;
    p.model.nodes = mesh.node_count();
    const auto boundary = extract_boundary<E>(mesh);
    p.nodes = static_cast<double>(mesh.node_count());
    for (const Selection& part : scene_.touched())
      p.touched += static_cast<double>(nodes_of(resolve_faces(mesh, boundary, part)).size());
    p.measure = [this, kept = std::move(mesh)](SuggestedModel& model) { measure(model, kept); };
  });
  return p;
}

PALPATE_INLINE void SuggestedModelMaker::finish(Pending& p) {
  constexpr double sure = 1.5;  // of the prediction
  if (!p.measure) return;
  if (p.touched >= too_many_touched_) {
    p.model.remark = "not tried: a tick takes longer than the budget even with fewer touchable nodes";
    return;
  }
  const double left = seconds_left(), expected = predicted(p);
  if (left <= 0.0) {
    p.model.remark = "not tried: the time for the suggestion is over";
  } else if (expected > sure * std::min(left, budget_.setup_seconds)) {
    p.model.setup = expected;
    p.model.remark = "not tried: its set-up is predicted to take " + number(std::round(10.0 * expected) / 10.0) + " s";
  } else {
    attempt(p.model, [&] { p.measure(p.model); });
  }
}

PALPATE_INLINE std::vector<double> SuggestedModelMaker::edges(std::initializer_list<double> parts) const {
  std::vector<double> edges;
  for (const double part : parts)
    if (const double edge = scene_.touch_radius() / part; edge < base_->errors.report().facet) edges.push_back(edge);
  return edges;
}

/// Those that are set up soonest first. Tet10 is more accurate than Smoothed<Tet4> after a set-up as long, and with as
/// many touchable nodes: it is tried before those that are set up in more than half of its time.
PALPATE_INLINE std::vector<SuggestedModelMaker::Pending> SuggestedModelMaker::refined() {
  std::vector<Pending> all;
  for (const double edge : edges({2.0, 3.0, 4.0, 5.0})) all.push_back(pending<Tet4>("Smoothed<Tet4>", edge));
  for (const double edge : edges({1.0, 2.0, 3.0})) all.push_back(pending<Tet10>("Tet10", edge));
  std::ranges::sort(all, {},
                    [this](const Pending& p) { return predicted(p) * (p.model.element == "Tet10" ? 0.5 : 1.0); });
  return all;
}

/// The mesh as given first: finer facets make more contacts and longer ticks.
PALPATE_INLINE std::vector<SuggestedModel> SuggestedModelMaker::make_all() {
  std::vector<SuggestedModel> models(1);
  models.front().element = "Tet4";
  make_base(models.front());
  if (!reference_remark_.empty()) return models;
  const auto finished = [&](Pending p) {
    finish(p);
    models.push_back(std::move(p.model));
  };
  finished(pending<Tet4>("Smoothed<Tet4>", 0.0));
  finished(pending<Tet10>("Tet10", 0.0));
  for (Pending& p : refined()) finished(std::move(p));
  return models;
}

}}}  // namespace palpate::detail
