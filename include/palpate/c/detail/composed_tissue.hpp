// A tissue of one composition.
#pragma once

#include <palpate/c/detail/any_tissue.hpp>
#include <palpate/model/rendering/visual_surface.hpp>

#include <type_traits>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// What VisualSurface needs of a model, for all models of one element, so that it is compiled once per element.
template <Element E>
class DrawnBody {
 public:
  using ElementType = E;

  template <class Model>
  explicit DrawnBody(Model& model)
      : base_(&model),
        mesh_(&model.mesh()),
        boundary_(&model.boundary()),
        model_(&model),
        displace_(&displace<Model>) {}

  const Mesh<E>& mesh() const noexcept { return *mesh_; }
  const std::vector<BoundaryFace>& boundary() const noexcept { return *boundary_; }
  const Vector3& origin() const noexcept { return base_->origin(); }
  Vector3 rest_position(NodeId node) const noexcept { return base_->rest_position(node); }
  const std::vector<NodeId>& rendered_nodes() const noexcept { return base_->rendered_nodes(); }
  const Eigen::Isometry3d& to_world() const noexcept { return base_->to_world(); }
  void displacement_with(std::span<const VertexForce> forces, VectorX& u) noexcept { displace_(model_, forces, u); }

 private:
  template <class Model>
  static void displace(void* model, std::span<const VertexForce> forces, VectorX& u) noexcept {
    static_cast<Model*>(model)->displacement_with(forces, u);
  }

  const ModelBase* base_;
  const Mesh<E>* mesh_;
  const std::vector<BoundaryFace>* boundary_;
  void* model_;
  void (*displace_)(void*, std::span<const VertexForce>, VectorX&) noexcept;
};

/// The surface of `Drawn`: a DrawnBody, or a model that can be cut.
template <class Drawn>
class SkinOf final : public Skin {
 public:
  template <class Model>
  explicit SkinOf(Model& model) : drawn_(model), surface_(drawn_) {}
  bool update() override { return surface_.update(); }
  Index point_count() const noexcept override { return surface_.point_count(); }
  const std::vector<std::array<int, 3>>& triangles() const noexcept override { return surface_.triangles(); }
  bool read(std::span<const VertexForce> forces, std::span<float> positions,
            std::span<float> normals) noexcept override {
    return surface_.read_surface(forces, positions, normals);
  }

 private:
  Drawn drawn_;
  VisualSurface<std::remove_reference_t<Drawn>> surface_;
};

template <class Model>
concept IsCut = requires(Model& model) {
  model.cut_report();
};

/// `Touched` is the base of Model that a servo sees, so that all models with this base share its functions.
template <class Model, class Touched>
class ComposedTissue final : public AnyTissue {
 public:
  template <class... Arguments>
  explicit ComposedTissue(Arguments&&... arguments) : model_(std::forward<Arguments>(arguments)...) {}

  const SetupReport& report() const noexcept override { return model_.report(); }
  const ModelBase& base() const noexcept override { return model_; }
  SolveReport displacement(VectorX& u) noexcept override { return model_.displacement_with({}, u); }
  std::unique_ptr<HapticServo> make_servo(const ToolList& tools, const ServoOptions& options) override {
    return std::make_unique<HapticServo>(static_cast<Touched&>(model_), tools, options);
  }
  std::unique_ptr<Skin> make_skin() override {
    if constexpr (IsCut<Model>)
      return std::make_unique<SkinOf<Model&>>(model_);
    else
      return std::make_unique<SkinOf<DrawnBody<typename Model::ElementType>>>(model_);
  }
  std::unique_ptr<BackgroundWorker> make_worker() override {
    if constexpr (HasBackgroundWork<Touched>)
      return std::make_unique<BackgroundWorker>(static_cast<Touched&>(model_));
    else
      return nullptr;
  }
  bool work() override {
    if constexpr (HasBackgroundWork<Touched>)
      return model_.background_work().worked;
    else
      return false;
  }
  void set_pose(const Eigen::Isometry3d& pose) override { model_.set_pose(pose); }
  void set_gravity(const Vector3& gravity) override { model_.set_gravity(gravity); }
  void reset() override { model_.reset(); }
  void cut(const BladeSweep& sweep) override {
    if constexpr (IsCut<Model>)
      model_.cut(sweep);
    else
      raise(SetupErrorKind::unsupported, "this tissue cannot be cut", "Choose a policy with a solver cuttable_...");
  }
  std::optional<CutReport> cut_report() override {
    if constexpr (IsCut<Model>)
      return model_.cut_report();
    else
      return std::nullopt;
  }

 private:
  Model model_;
};

}}}  // namespace palpate::PALPATE_ABI::c_interface
