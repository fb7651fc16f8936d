// Definitions of linear_tissue.hpp.
#pragma once

#include <palpate/model/static/linear_tissue.hpp>

#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>
#include <palpate/model/detail/touchable.hpp>
#include <palpate/model/static/detail/force_error_source.hpp>
#include <palpate/model/static/detail/statics.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

template <std::floating_point Scalar>
LinearTissue<Scalar>::LinearTissue(const SetupOptions& options) : ModelBase(options) {}
template <std::floating_point Scalar>
LinearTissue<Scalar>::LinearTissue(LinearTissue&&) noexcept = default;
template <std::floating_point Scalar>
LinearTissue<Scalar>& LinearTissue<Scalar>::operator=(LinearTissue&&) noexcept = default;
template <std::floating_point Scalar>
LinearTissue<Scalar>::~LinearTissue() = default;

template <std::floating_point Scalar>
const VectorX& LinearTissue<Scalar>::displacement() const noexcept {
  return statics_->displacement();
}
template <std::floating_point Scalar>
VectorX LinearTissue<Scalar>::internal_force() const {
  return statics_->internal_force();
}
template <std::floating_point Scalar>
VectorX LinearTissue<Scalar>::reactions() const {
  return statics_->reactions();
}
template <std::floating_point Scalar>
SolveReport LinearTissue<Scalar>::displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept {
  return statics_->displacement_with(forces, touchable_nodes(), u);
}
template <std::floating_point Scalar>
VectorX LinearTissue<Scalar>::displacement(std::span<const VertexForce> forces) {
  detail::require_vertex_forces(forces, static_cast<int>(touchable_nodes().size()));
  VectorX u(displacement().size());
  const SolveReport solved = displacement_with(forces, u);
  if (!solved.converged)
    raise(SetupErrorKind::not_converged,
          "the static solve stopped at a relative residual of " + number(solved.relative_residual),
          "Use a direct solver");
  return u;
}
template <std::floating_point Scalar>
double LinearTissue<Scalar>::strain_energy() const {
  return elastic_body().strain_energy(statics_->displacement());
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_up(const Scene& scene, detail::AdmittedBody admitted, MakeStiffness make_stiffness,
                                  const detail::SolverRecipe& recipe, const SetupOptions& options) {
  const detail::Touchable touchable = admit(scene, std::move(admitted));
  const ScopedIdTranslation translation(original_ids());
  SetupReport& report = setup_report();
  elastic_body().report_locking(report);
  statics_ = std::make_unique<Statics>(elastic_body(), this->scene(), touchable.nodes, make_stiffness, recipe, limits(),
                                       options.cache_file, report);
  statics_->set_conditions(this->scene(), gravity(), reporting_to(report), limits().threads);
  shell_nodes_ = touchable.shell_nodes;
  prepare_contact(touchable, recipe.eager, options);
  if (options.force_error.measure != nullptr) measure_force_error(options.force_error);
  if (report.asynchronous_columns) compliance_.fill_asynchronously();  // the measurement needs all columns
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::measure_force_error(const ForceErrorOptions& options) {
  const detail::StageTimer timer(setup_report(), "accuracy");
  limits().advance("accuracy", 0.0);
  const double radius = scene().touch_radius();
  std::shared_ptr<const ForceAccuracy> measured;
  if (radius > 0.0)
    measured =
        options.measure({elastic_body(), statics_->conditions(), touchable_nodes(), surface_, to_world().translation(),
                         radius, scene().is_pinched(), options.places, node_map(), options.coarse},
                        TissueView(*this), limits(), setup_report());
  else
    setup_report().accuracy.remark = "the scene does not give the radius of the tool: touch(where, {.radius = ...})";
  setup_report().require_accuracy(options.wanted);
  surface_.set_force_accuracy(std::move(measured));
}

/// A solve loses the digits of the condition number, if that is known, and what the probe solve lost. The columns have
/// their error relative to the largest displacement.
template <std::floating_point Scalar>
detail::LinearModelError LinearTissue<Scalar>::model_error() const {
  constexpr double unit_roundoff = 0.5 * std::numeric_limits<double>::epsilon();
  constexpr double stored = std::same_as<Scalar, float> ? 0.5 * std::numeric_limits<float>::epsilon() : 0.0;
  double largest = 0.0;
  for (int v = 0; v < surface_.vertex_count(); ++v) largest = std::max(largest, compliance_.bound(v));
  const double lost = std::max(report().probe_error, unit_roundoff * report().condition_estimate);
  detail::LinearModelError error{std::sqrt(3.0) * stored * largest, lost * largest, 0.0, {}};
  Vector3 low = Vector3::Constant(infinity), high = -low;
  std::vector<Vector3> constrained;
  const auto& positions = elastic_body().positions();
  for (std::size_t i = 0; i < positions.size(); ++i) {
    low = low.cwiseMin(positions[i]);
    high = high.cwiseMax(positions[i]);
    const Index first = 3 * static_cast<Index>(i);
    const EssentialConditions& conditions = statics_->conditions();
    if (conditions.is_constrained(first) || conditions.is_constrained(first + 1) ||
        conditions.is_constrained(first + 2))
      constrained.push_back(positions[i]);
  }
  error.body_size = (high - low).maxCoeff();
  for (const NodeId node : touchable_nodes()) {
    double square = infinity;
    for (const Vector3& p : constrained)
      square = std::min(square, (p - positions[static_cast<std::size_t>(node)]).squaredNorm());
    error.supports.push_back(std::sqrt(square));
  }
  return error;
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_conditions(const Scene& scene) {
  const ScopedIdTranslation translation(original_ids());
  const Scene mapped = this->mapped(scene, surface_.triangles());
  std::string others = mapped.loads_in_words(), loads = detail::loads_in_words(scene.gravity(), others);
  SetupReport changed = report();
  statics_->set_conditions(mapped, local(scene.gravity(), pose()), reporting_to(changed));
  keep_loads(scene.gravity(), others);
  accept_displacement(changed);
  surface_.set_loads(std::move(loads));
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_gravity(const Vector3& gravity) {
  require_finite_gravity(gravity);
  std::string loads = detail::loads_in_words(gravity, other_loads());
  SetupReport changed = report();
  statics_->set_gravity(local(gravity, pose()), reporting_to(changed));
  keep_gravity(gravity);
  accept_displacement(changed);
  surface_.set_loads(std::move(loads));
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_pose(const Eigen::Isometry3d& pose) {
  require_rigid(pose);
  SetupReport changed = report();
  if (!gravity().isZero(0.0)) statics_->set_gravity(local(gravity(), pose), reporting_to(changed));
  place(pose);
  accept_displacement(changed);
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::reset() {
  std::string others = scene().loads_in_words(), loads = detail::loads_in_words(scene().gravity(), others);
  SetupReport changed = report();
  statics_->set_conditions(scene(), scene().gravity(), reporting_to(changed));
  place(Eigen::Isometry3d::Identity());
  keep_loads(scene().gravity(), others);
  accept_displacement(changed);
  surface_.set_loads(std::move(loads));
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::prepare_contact(const detail::Touchable& touchable, bool eager,
                                           const SetupOptions& options) {
  const detail::StageTimer timer(setup_report(), "compliance");
  const int vertices = static_cast<int>(touchable_nodes().size());
  compliance_ = detail::ContactCompliance<Scalar>(statics_->system(), kept_index(),
                                                  eager ? vertices : options.compliance_slots, limits());
  if (eager)
    for (int v = 0; v < vertices; ++v) {
      if (v % 64 == 0) limits().advance("compliance", static_cast<double>(v) / static_cast<double>(vertices));
      require_columns({&v, 1});
    }
  else if (vertices > 0)
    sample_columns(options.columns);
  // 1e-9 of the largest compliance of the tissue, or 1 nm/N when nothing moves.
  for (int v = 0; v < vertices; ++v) compliance_floor_ = std::max(compliance_floor_, 1e-9 * compliance_.bound(v));
  if (compliance_floor_ == 0.0) compliance_floor_ = 1e-9;
  std::vector<Vector3> positions;
  for (NodeId node : touchable_nodes()) positions.push_back(deformed(node));
  surface_ = ContactSurface(positions, touchable.triangles);
  surface_.set_unloaded(unloaded());
  surface_.set_materials(elastic_body().contact_materials(touchable.elements));
  surface_.set_subfacet(std::make_shared<SubfacetCompliance>(
      elastic_body().half_space(touchable_nodes(), statics_->conditions(), limits())));
  surface_.set_model_error(model_error());
  moved_ = std::move(positions);
  for (const NodeId node : touchable.shell_nodes) moved_.push_back(deformed(node));
  surface_.add_shell(std::span(moved_).subspan(touchable.nodes.size()), touchable.shell);
  if (const int edges = surface_.crowded_edges())
    setup_report().set(SetupFlag::non_manifold, "more than two touchable triangles meet at " + std::to_string(edges) +
                                                    " edges: the contact is not smooth across them");
  setup_report().compliance_bytes = compliance_.bytes();
  limits().advance("checks", 1.0);
}

template <std::floating_point Scalar>
std::vector<Index> LinearTissue<Scalar>::kept_index() const {
  std::vector<Index> index(3 * touchable_nodes().size(), -1);
  Index kept = 0;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (!statics_->conditions().is_constrained(3 * Index{touchable_nodes()[i / 3]} + static_cast<Index>(i % 3)))
      index[i] = kept++;
  return index;
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::sample_columns(ColumnFill fill) {
  const int vertices = static_cast<int>(touchable_nodes().size());
  const std::array sampled{0, vertices / 2, vertices - 1};
  const auto start = std::chrono::steady_clock::now();
  require_columns(sampled);
  setup_report().column_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 3.0;
  double softest = 0.0;
  for (int v : sampled) softest = std::max(softest, compliance_.bound(v));
  compliance_.assume(softest / std::sqrt(3.0));
  setup_report().asynchronous_columns =
      fill == ColumnFill::asynchronous || (fill == ColumnFill::automatic && is_column_late());
}

template <std::floating_point Scalar>
bool LinearTissue<Scalar>::is_column_late() const {
  constexpr double most_numbers = 1e5;  // a core reads about two numbers of a factor per nanosecond
  detail::AnyStaticSystem system = statics_->system();
  if (system.kept() == 0) return false;
  VectorX column(system.kept());
  const int iterations = system.compliance_column(0, column).iterations;
  const double sweeps = iterations == 0 ? 2.0 : 1.0 + iterations;
  const std::size_t bytes = system.column_bytes() + (iterations == 0 ? 0 : report().stiffness_bytes);
  return 3.0 * sweeps * static_cast<double>(bytes / sizeof(double)) > most_numbers;
}

template <std::floating_point Scalar>
Vector3 LinearTissue<Scalar>::deformed(NodeId node) const noexcept {
  return elastic_body().positions()[static_cast<std::size_t>(node)] + node_vector(displacement(), node);
}

template <std::floating_point Scalar>
std::function<void(const VectorX&)> LinearTissue<Scalar>::reporting_to(SetupReport& report) const {
  return [this, &report](const VectorX& u) { detail::report_displacement(elastic_body().positions(), u, report); };
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::accept_displacement(SetupReport& report) noexcept {
  std::swap(setup_report(), report);
  move_surface();
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::move_surface() noexcept {
  const std::size_t touchable = touchable_nodes().size();
  for (std::size_t v = 0; v < moved_.size(); ++v)
    moved_[v] = deformed(v < touchable ? touchable_nodes()[v] : shell_nodes_[v - touchable]);
  surface_.move_to(moved_);
}

#if !PALPATE_HEADER_ONLY
template class LinearTissue<float>;
template class LinearTissue<double>;
#endif

}}  // namespace palpate
