#pragma once

#include "model/any_model.hpp"

#include <palpate/contact/tissue_view.hpp>

namespace test {

/// The options with columns computed in the call that requests them, because the tests compare results immediately.
inline SetupOptions synchronous(SetupOptions options) {
  options.columns = ColumnFill::synchronous;
  return options;
}

/// AnyModel of one policy.
template <class Policy>
class ModelOf final : public AnyModel {
 public:
  ModelOf(const Mesh<Tet4>& mesh, const Scene& scene, const Materials& materials, const SetupOptions& options)
      : model_(mesh, scene, materials, synchronous(options)) {}

  const SetupReport& report() const override { return model_.report(); }
  const Mesh<Tet4>& mesh() const override { return model_.mesh(); }
  const std::vector<NodeId>& node_map() const override { return model_.node_map(); }
  const std::vector<NodeId>& touchable_nodes() const override { return model_.touchable_nodes(); }
  const std::vector<NodeId>& rendered_nodes() const override { return model_.rendered_nodes(); }
  Vector3 rest_position(NodeId node) const override { return model_.rest_position(node); }
  const VectorX& displacement() const override { return model_.displacement(); }
  VectorX internal_force() const override { return model_.internal_force(); }
  VectorX reactions() const override { return model_.reactions(); }
  double strain_energy() const override { return model_.strain_energy(); }
  SolveReport displacement_with(std::span<const VertexForce> forces, VectorX& u) override {
    return model_.displacement_with(forces, u);
  }
  void set_conditions(const Scene& scene) override { model_.set_conditions(scene); }
  void set_gravity(const Vector3& gravity) override { model_.set_gravity(gravity); }
  void set_pose(const Eigen::Isometry3d& pose) override { model_.set_pose(pose); }
  const Eigen::Isometry3d& pose() const noexcept override { return model_.pose(); }
  void reset() override { model_.reset(); }
  const ContactSurface& contact_surface() const noexcept override { return model_.contact_surface(); }
  Status require_columns(std::span<const int> vertices) noexcept override { return model_.require_columns(vertices); }
  void prefetch(std::span<const int> vertices) noexcept override { model_.prefetch(vertices); }
  Matrix3 half_space_map(int v) const noexcept override {
    return TissueView(const_cast<HapticFEModel<Tet4, LinearElastic, Policy>&>(model_)).half_space_map(v);
  }
  Matrix3 compliance(int i, int j) const noexcept override { return model_.compliance(i, j); }
  double compliance_bound(int j) const noexcept override { return model_.compliance_bound(j); }
  std::uint64_t compliance_revision() const noexcept override { return model_.compliance_revision(); }
  double compliance_floor() const noexcept override { return model_.compliance_floor(); }
  const Eigen::Isometry3d& to_world() const noexcept override { return model_.to_world(); }

 private:
  HapticFEModel<Tet4, LinearElastic, Policy> model_;
};

}  // namespace test
