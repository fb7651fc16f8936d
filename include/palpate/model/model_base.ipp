// Definitions of model_base.hpp.
#pragma once

#include <palpate/model/model_base.hpp>

#include <palpate/core/rigid_motion.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/touchable.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ModelBase::ModelBase(const SetupOptions& options)
    : limits_{options.progress, options.memory_limit, options.threads},
      refuses_units_(options.admission.units == Admission::refuse) {}
PALPATE_INLINE ModelBase::ModelBase(ModelBase&&) noexcept = default;
PALPATE_INLINE ModelBase& ModelBase::operator=(ModelBase&&) noexcept = default;
PALPATE_INLINE ModelBase::~ModelBase() = default;

PALPATE_INLINE Vector3 ModelBase::rest_position(NodeId node) const noexcept {
  return origin_ + body_->positions()[static_cast<std::size_t>(node)];
}

PALPATE_INLINE detail::Touchable ModelBase::admit(const Scene& scene, detail::AdmittedBody admitted) {
  node_map_ = std::move(admitted.node_map);
  original_ids_ = std::move(admitted.ids);
  body_ = std::move(admitted.body);
  origin_ = admitted.origin;
  const ScopedIdTranslation translation(original_ids_);
  scene_ = scene.mapped(node_map_, origin_);
  gravity_ = scene_.gravity();
  other_loads_ = scene_.loads_in_words();
  place(Eigen::Isometry3d::Identity());
  detail::Touchable touchable = body_->touchable(scene_);
  touchable_ = touchable.nodes;
  rendered_ = body_->rendered(scene_);
  report_.touchable_vertices = static_cast<Index>(touchable_.size());
  report_.rendered_nodes = static_cast<Index>(rendered_.size());
  const UnitCheck units{body_->region_names(), body_->elasticities(), body_->densities(), gravity_.norm(),
                        scene_.touch_radius()};
  detail::report_units(units, refuses_units_, report_);
  detail::report_fixed_contact(body_->conditions(scene_).constrained, touchable_, report_);
  return touchable;
}

PALPATE_INLINE std::vector<std::string> ModelBase::notes() const {
  std::vector<std::string> all;
  for (const auto& [flag, remark] : report_.remarks) all.push_back(remark);
  return all;
}

PALPATE_INLINE ContactSurface::Unloaded ModelBase::unloaded() const {
  ContactSurface::Unloaded unloaded{{}, detail::loads_in_words(gravity_, other_loads_)};
  for (const NodeId node : touchable_) unloaded.positions.push_back(body_->positions()[static_cast<std::size_t>(node)]);
  return unloaded;
}

PALPATE_INLINE Scene ModelBase::mapped(const Scene& scene, const std::vector<Triangle>& triangles) const {
  Scene mapped = scene.mapped(node_map_, origin_);
  if (mapped.touched().empty()) return mapped;
  const detail::Touchable touchable = body_->touchable(mapped);
  if (touchable.nodes != touchable_ || touchable.triangles != triangles)
    raise(SetupErrorKind::unsupported,
          "the new scene lets tools touch " + std::to_string(touchable.nodes.size()) + " nodes and " +
              std::to_string(touchable.triangles.size()) + " triangles, but the model was made for another set of " +
              std::to_string(touchable_.size()) + " and " + std::to_string(triangles.size()),
          "Loads may change, the touchable set may not: make a new model, or leave touch out of the scene");
  return mapped;
}

PALPATE_INLINE Vector3 ModelBase::local(const Vector3& gravity, const Eigen::Isometry3d& pose) noexcept {
  return rotation_of(pose).transpose() * gravity;
}

PALPATE_INLINE void ModelBase::require_finite_gravity(const Vector3& gravity) {
  if (!all_finite(gravity)) raise(SetupErrorKind::non_finite, "gravity is not finite");
}

PALPATE_INLINE void ModelBase::require_rigid(const Eigen::Isometry3d& pose) {
  if (!all_finite(pose.matrix()) || !is_rotation(rotation_of(pose)))
    raise(SetupErrorKind::bad_argument, "the pose is not a rigid motion",
          "Give a proper rotation and a finite translation");
}

PALPATE_INLINE void ModelBase::place(const Eigen::Isometry3d& pose) noexcept {
  pose_ = pose;
  world_ = make_pose(rotation_of(pose), pose * origin_);
}

}}  // namespace palpate
