// Definitions of linear_tissue.hpp.
#pragma once

#include <palpate/model/linear_tissue.hpp>

#include <palpate/core/rigid_motion.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/elastic_body.hpp>
#include <palpate/model/stage_timer.hpp>
#include <palpate/model/statics.hpp>
#include <palpate/model/touchable.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

template <std::floating_point Scalar>
LinearTissue<Scalar>::LinearTissue(const SetupOptions& options) : limits_{options.progress, options.memory_limit} {}
template <std::floating_point Scalar>
LinearTissue<Scalar>::LinearTissue(LinearTissue&&) noexcept = default;
template <std::floating_point Scalar>
LinearTissue<Scalar>& LinearTissue<Scalar>::operator=(LinearTissue&&) noexcept = default;
template <std::floating_point Scalar>
LinearTissue<Scalar>::~LinearTissue() = default;

template <std::floating_point Scalar>
Vector3 LinearTissue<Scalar>::rest_position(NodeId node) const noexcept {
  return origin_ + statics_->body().positions()[static_cast<std::size_t>(node)];
}
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
  return statics_->displacement_with(forces, touchable_, u);
}
template <std::floating_point Scalar>
VectorX LinearTissue<Scalar>::displacement(std::span<const VertexForce> forces) {
  require_vertex_forces(forces, static_cast<int>(touchable_.size()));
  VectorX u(displacement().size());
  const SolveReport solved = displacement_with(forces, u);
  if (!solved.converged)
    raise(SetupErrorKind::not_converged,
          "the static solve stopped at a relative residual of " + number(solved.relative_residual),
          "Use a direct solver");
  return u;
}
template <std::floating_point Scalar>
const ElasticBody& LinearTissue<Scalar>::elastic_body() const noexcept {
  return statics_->body();
}
template <std::floating_point Scalar>
double LinearTissue<Scalar>::strain_energy() const {
  return statics_->body().strain_energy(statics_->displacement());
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_up(const Scene& scene, AdmittedBody admitted, MakeStiffness make_stiffness,
                                  const SolverRecipe& recipe, const SetupOptions& options) {
  node_map_ = std::move(admitted.node_map);
  original_ids_ = std::move(admitted.ids);
  const ScopedIdTranslation translation(original_ids_);
  origin_ = admitted.origin;
  scene_ = scene.mapped(node_map_, origin_);
  place(Eigen::Isometry3d::Identity());
  const ElasticBody& body = *admitted.body;
  body.report_locking(report_);
  const Touchable touchable = body.touchable(scene_);
  touchable_ = touchable.nodes;
  seen_ = body.seen(scene_);
  statics_ = std::make_unique<Statics>(std::move(admitted.body), scene_, touchable_, make_stiffness, recipe, limits_,
                                       options.cache_file, report_);
  statics_->set_conditions(scene_, scene_.gravity(), reporting_to(report_));
  gravity_ = scene_.gravity();
  loads_ = scene_.loads_in_words();
  prepare_contact(touchable.triangles, recipe.eager, options);
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_conditions(const Scene& scene) {
  const ScopedIdTranslation translation(original_ids_);
  const Scene mapped = scene.mapped(node_map_, origin_);
  require_same_touch(mapped);
  SetupReport report = report_;
  std::string loads = mapped.loads_in_words(), in_all = loads_in_words(scene.gravity(), loads);
  statics_->set_conditions(mapped, rotation_of(pose_).transpose() * scene.gravity(), reporting_to(report));
  gravity_ = scene.gravity();
  accept_displacement(report);
  loads_.swap(loads);
  surface_.set_loads(std::move(in_all));
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::require_same_touch(const Scene& mapped) const {
  if (mapped.touched().empty()) return;
  const Touchable touchable = statics_->body().touchable(mapped);
  if (touchable.nodes == touchable_ && touchable.triangles == surface_.triangles()) return;
  raise(SetupErrorKind::unsupported,
        "the new scene lets tools touch " + std::to_string(touchable.nodes.size()) + " nodes and " +
            std::to_string(touchable.triangles.size()) + " triangles, the model was made for another set of " +
            std::to_string(touchable_.size()) + " and " + std::to_string(surface_.triangles().size()),
        "Loads may change, what tools touch may not: make a new model, or leave touch out of the scene");
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_gravity(const Vector3& gravity) {
  if (!all_finite(gravity)) raise(SetupErrorKind::non_finite, "gravity is not finite");
  SetupReport report = report_;
  std::string loads = loads_in_words(gravity, loads_);
  statics_->set_gravity(rotation_of(pose_).transpose() * gravity, reporting_to(report));
  gravity_ = gravity;
  accept_displacement(report);
  surface_.set_loads(std::move(loads));
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::set_pose(const Eigen::Isometry3d& pose) {
  if (!all_finite(pose.matrix()) || !is_rotation(rotation_of(pose)))
    raise(SetupErrorKind::bad_argument, "the pose is not a rigid motion",
          "Give a proper rotation and a finite translation");
  SetupReport report = report_;
  if (!gravity_.isZero(0.0)) statics_->set_gravity(rotation_of(pose).transpose() * gravity_, reporting_to(report));
  place(pose);
  accept_displacement(report);
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::reset() {
  SetupReport report = report_;
  std::string loads = scene_.loads_in_words(), in_all = loads_in_words(scene_.gravity(), loads);
  statics_->set_conditions(scene_, scene_.gravity(), reporting_to(report));
  place(Eigen::Isometry3d::Identity());
  gravity_ = scene_.gravity();
  accept_displacement(report);
  loads_.swap(loads);
  surface_.set_loads(std::move(in_all));
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::prepare_contact(const std::vector<Triangle>& triangles, bool eager,
                                           const SetupOptions& options) {
  const StageTimer timer(report_, "compliance");
  const int vertices = static_cast<int>(touchable_.size());
  compliance_ =
      ContactCompliance<Scalar>(statics_->system(), kept_index(), eager ? vertices : options.compliance_slots, limits_);
  if (eager)
    for (int v = 0; v < vertices; ++v) {
      if (v % 64 == 0) limits_.advance("compliance", static_cast<double>(v) / static_cast<double>(vertices));
      require_columns({&v, 1});
    }
  else if (vertices > 0)
    sample_columns(options.columns);
  // A thousandth of a millionth of the tissue's own compliance, or a nanometre per newton where nothing moves.
  for (int v = 0; v < vertices; ++v) compliance_floor_ = std::max(compliance_floor_, 1e-9 * compliance_.bound(v));
  if (compliance_floor_ == 0.0) compliance_floor_ = 1e-9;
  std::vector<Vector3> positions, unloaded;
  for (NodeId node : touchable_) {
    positions.push_back(deformed(node));
    unloaded.push_back(statics_->body().positions()[static_cast<std::size_t>(node)]);
  }
  surface_ = ContactSurface(positions, triangles);
  surface_.set_unloaded({std::move(unloaded), loads_in_words(gravity_, loads_)});
  moved_ = std::move(positions);
  if (const int edges = surface_.crowded_edges())
    report_.set(SetupFlag::non_manifold, "more than two touchable triangles meet at " + std::to_string(edges) +
                                             " edges: contact does not pass across them smoothly");
  report_.touchable_vertices = vertices;
  report_.seen_nodes = static_cast<Index>(seen_.size());
  report_.compliance_bytes = compliance_.bytes();
  limits_.advance("checks", 1.0);
}

template <std::floating_point Scalar>
std::vector<Index> LinearTissue<Scalar>::kept_index() const {
  std::vector<Index> index(3 * touchable_.size(), -1);
  Index kept = 0;
  for (std::size_t i = 0; i < index.size(); ++i)
    if (!statics_->conditions().is_constrained(3 * Index{touchable_[i / 3]} + static_cast<Index>(i % 3)))
      index[i] = kept++;
  return index;
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::sample_columns(ColumnFill fill) {
  const int vertices = static_cast<int>(touchable_.size());
  const std::array sampled{0, vertices / 2, vertices - 1};
  const auto start = std::chrono::steady_clock::now();
  require_columns(sampled);
  report_.column_seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() / 3.0;
  double softest = 0.0;
  for (int v : sampled) softest = std::max(softest, compliance_.bound(v));
  compliance_.assume(softest / std::sqrt(3.0));
  report_.asynchronous_columns =
      fill == ColumnFill::asynchronous || (fill == ColumnFill::automatic && is_column_late());
  if (report_.asynchronous_columns) compliance_.fill_asynchronously();
}

template <std::floating_point Scalar>
bool LinearTissue<Scalar>::is_column_late() const {
  constexpr double most_numbers = 1e5;  // a core reads about two of a factor per nanosecond
  AnyStaticSystem system = statics_->system();
  if (system.kept() == 0) return false;
  VectorX column(system.kept());
  const int iterations = system.compliance_column(0, column).iterations;
  const double sweeps = iterations == 0 ? 2.0 : 1.0 + iterations;
  const std::size_t bytes = system.column_bytes() + (iterations == 0 ? 0 : report_.stiffness_bytes);
  return 3.0 * sweeps * static_cast<double>(bytes / sizeof(double)) > most_numbers;
}

template <std::floating_point Scalar>
Vector3 LinearTissue<Scalar>::deformed(NodeId node) const noexcept {
  return statics_->body().positions()[static_cast<std::size_t>(node)] + node_vector(displacement(), node);
}

template <std::floating_point Scalar>
std::function<void(const VectorX&)> LinearTissue<Scalar>::reporting_to(SetupReport& report) const {
  return [this, &report](const VectorX& u) { report_displacement(statics_->body().positions(), u, report); };
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::accept_displacement(SetupReport& report) noexcept {
  std::swap(report_, report);
  move_surface();
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::place(const Eigen::Isometry3d& pose) noexcept {
  pose_ = pose;
  world_ = make_pose(rotation_of(pose), pose * origin_);
}

template <std::floating_point Scalar>
void LinearTissue<Scalar>::move_surface() noexcept {
  for (std::size_t v = 0; v < touchable_.size(); ++v) moved_[v] = deformed(touchable_[v]);
  surface_.move_to(moved_);
}

#if !PALPATE_HEADER_ONLY
template class LinearTissue<float>;
template class LinearTissue<double>;
#endif

}}  // namespace palpate
