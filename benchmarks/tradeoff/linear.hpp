// Linear compositions rendered by a servo.
#pragma once

#include <palpate/element/tet10.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <optional>

#include "contender.hpp"

namespace tradeoff {

/// A servo without virtual coupling: the spheres are at the device position, and the force is that of the tissue only;
/// `corrected`: ServoOptions::corrected_force.
template <TissueModel Tissue>
class RenderedTissue {
 public:
  RenderedTissue(Tissue& tissue, const PressScene& scene, bool corrected = false)
      : servo_(tissue, std::vector<SphereTool>(scene.spheres.size(), SphereTool{scene.radius}), uncoupled(corrected)),
        states_(scene.spheres.size()),
        forces_(scene.spheres.size()) {}

  std::span<const Vector3> tick(std::span<const Vector3> centres) noexcept {
    for (std::size_t b = 0; b < centres.size(); ++b) {
      states_[b].position = centres[b];
      states_[b].time = 1e-3 * static_cast<double>(count_);
    }
    ++count_;
    for (const GatedForce& f : servo_.tick(states_)) status_ |= f.status;
    for (std::size_t b = 0; b < forces_.size(); ++b) {
      forces_[b] = servo_.tick_view().contact_force(b);
      const double size = forces_[b].norm();
      if (size > 0.0) forces_[b] *= servo_.tick_view().force_error(b).force / size;
    }
    return forces_;
  }
  auto& servo() noexcept { return servo_; }
  const auto& servo() const noexcept { return servo_; }
  std::span<const VertexForce> vertex_forces() { return servo_.read_snapshot().vertex_forces(); }
  /// Status flags of all ticks as text, without those of the gate.
  std::string remark() const {
    std::string text;
    for (int bit = 0; bit < status_flag_count; ++bit) {
      const auto flag = static_cast<StatusFlag>(1u << bit);
      const bool of_gate =
          flag == StatusFlag::saturated || flag == StatusFlag::slew_limited || flag == StatusFlag::ramping;
      if (status_.has(flag) && !of_gate) text += (text.empty() ? "" : ", ") + std::string(status_flag_name(bit));
    }
    return text;
  }

 private:
  static ServoOptions uncoupled(bool corrected) {
    ServoOptions options;
    options.coupling_stiffness = infinity;
    options.corrected_force = corrected;
    return options;
  }

  HapticServo servo_;
  std::vector<ToolState> states_;
  std::vector<Vector3> forces_;
  Status status_;
  long count_ = 0;
};

/// The mesh converted for element E.
template <Element E>
auto mesh_for(const Mesh<Tet4>& mesh) {
  if constexpr (std::same_as<E, Tet10>)
    return promote<Tet10>(mesh);
  else
    return mesh;
}

/// The part of u, 3 per admitted node, for the nodes of the given mesh.
inline VectorX of_given_nodes(const VectorX& u, const std::vector<NodeId>& map, Index count) {
  VectorX given = VectorX::Zero(3 * count);
  for (Index i = 0; i < count; ++i)
    if (const NodeId node = map[static_cast<std::size_t>(i)]; node >= 0)
      given.segment<3>(3 * i) = u.segment<3>(3 * Index{node});
  return given;
}

/// Largest error of the contact, relative to the small depth: distance of pressing points from their sphere, and
/// displacement of their vertices by the compliance of the ticks, compared with that of the whole body (u, 3 per
/// admitted node) under the same forces. Contacts with less than 1 % of the largest force may still be settling.
template <class Model, class Tissue, class Servo>
double contact_error(const Model& model, const Tissue& tissue, Servo& servo, const VectorX& u,
                     const PressScene& scene) {
  const ServoSnapshot& snapshot = servo.read_snapshot();
  double worst = 0.0, largest = 0.0;
  for (const ToolContact& c : snapshot.tool_contacts()) largest = std::max(largest, c.force);
  for (const ToolContact& c : snapshot.tool_contacts()) {
    if (!(c.force > 0.01 * largest)) continue;
    const double distance = (snapshot.proxies[static_cast<std::size_t>(c.tool)] - c.point).norm();
    worst = std::max(worst, std::abs(distance - scene.radius));
    for (const int vertex : c.vertices) {
      Vector3 moved = Vector3::Zero();
      for (const VertexForce& f : snapshot.vertex_forces())
        moved += tissue.compliance(vertex, f.vertex) * f.force.in_model_axes();
      const NodeId node = model.touchable_nodes()[static_cast<std::size_t>(vertex)];
      worst = std::max(worst, (moved - u.segment<3>(3 * Index{node})).norm());
    }
  }
  return largest > 0.0 ? worst / scene.small : infinity;
}

/// HapticFEModel<E, LinearElastic, Policy>, rendered directly or through an adapter `Over`.
template <class E, class Policy, class Over = HapticFEModel<E, LinearElastic, Policy>&>
class LinearContender : public Contender {
 public:
  using Model = HapticFEModel<E, LinearElastic, Policy>;

  LinearContender(const Bench& bench, const std::string& mesh, const std::string& kept,
                  const SetupOptions& options = {})
      : LinearContender(bench, mesh, kept, options, [](Model& model) -> Model& { return model; }) {}
  LinearContender(const Bench& bench, const std::function<Model()>& make, bool corrected = false)
      : bench_(bench),
        model_(make()),
        tissue_(model_),
        rendered_(model_, bench_.scene, corrected),
        u_(3 * model_.mesh().node_count()) {}

  std::span<const Vector3> tick(std::span<const Vector3> centres) override { return rendered_.tick(centres); }
  double force_error_bound(std::size_t sphere) const override {
    return rendered_.servo().tick_view().force_error(sphere).bound;
  }
  VectorX displacement() override {
    model_.displacement_with(rendered_.vertex_forces(), u_);
    return of_given_nodes(u_, model_.node_map(), bench_.scene.mesh.node_count());
  }
  double own_error() override { return contact_error(model_, tissue_, rendered_.servo(), u_, bench_.scene); }
  Index nodes() const override { return model_.mesh().node_count(); }
  Index kept_dofs() const override { return model_.report().kept_dofs; }
  std::string remark() override { return rendered_.remark(); }

 protected:
  /// `over` constructs the rendered tissue from the model.
  template <class Make>
  LinearContender(const Bench& bench, const std::string& mesh, const std::string& kept, const SetupOptions& options,
                  Make over)
      : bench_(bench),
        model_(mesh_for<E>(bench.mesh(mesh)), bench.scene.scene(kept), bench.scene.materials, options),
        tissue_(over(model_)),
        rendered_(tissue_, bench.scene),
        u_(3 * model_.mesh().node_count()) {}

  const Bench& bench_;
  Model model_;
  Over tissue_;
  RenderedTissue<std::remove_reference_t<Over>> rendered_;
  VectorX u_;
};

inline const char* kept_name(const std::string& group) {
  return group == near_group ? "near the tool" : group == wide_group ? "touchable group" : "whole surface";
}

/// An entry for one composition; `element` and `policy` are their C++ names.
template <class E, class Policy>
Entry linear_entry(const Bench& bench, const std::string& element, const std::string& policy, const std::string& mesh,
                   const std::string& kept, const SetupOptions& options = {.columns = ColumnFill::synchronous}) {
  Entry entry;
  Description& d = entry.description;
  const bool condensed = policy.starts_with("Condensed");
  d.family = condensed ? "condensed" : "uncondensed";
  d.element = element;
  d.mesh = mesh_name(mesh);
  d.kinematics = "linear";
  d.solver = policy;
  d.kept = condensed ? kept_name(kept) : "";
  d.scalar = policy.find("Float") != policy.npos ? "float" : "double";
  if (options.columns == ColumnFill::asynchronous) d.work = "columns ahead";
  d.own_core = options.columns == ColumnFill::asynchronous;
  d.allowed = policy.find("Gradient") != policy.npos ? 2e-2 : 1e-2;
  d.paste = "using Model = HapticFEModel<" + element + ", LinearElastic, " + policy + ">;";
  entry.make = [&bench, mesh, kept, options] {
    return std::make_unique<LinearContender<E, Policy>>(bench, mesh, kept, options);
  };
  return entry;
}

}  // namespace tradeoff
