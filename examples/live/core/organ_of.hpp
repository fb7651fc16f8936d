// The organ of one composition.
#pragma once

#include <palpate/io/vtu.hpp>
#include <palpate/model/model_base.hpp>
#include <palpate/model/rendering/visual_surface.hpp>
#include <palpate/post/stress.hpp>

#include "organ.hpp"

#include <map>

namespace live {

template <class Material>
RegionMaterials<Material> materials_of(const TouchScene& scene, const Tuning& tuning) {
  RegionMaterials<Material> all;
  for (const Tissue& t : scene.tissues) {
    Material material;
    material.youngs_modulus = tuning.stiffness * t.youngs_modulus;
    material.poisson_ratio = t.poisson_ratio;
    material.density = t.density;
    all.push_back({t.region, material});
  }
  return all;
}

/// A model, its drawn surface, and loads that change with time. With `linear_stress` the colour can show the von Mises
/// stress.
template <class Model, bool linear_stress>
class OrganOf final : public Organ {
 public:
  using E = typename Model::ElementType;

  template <class... Arguments>
  explicit OrganOf(const TouchScene& scene, Arguments&&... arguments)
      : model_(std::forward<Arguments>(arguments)...), drawn_(model_), conditions_at_(scene.conditions_at) {}

  const SetupReport& report() const override { return model_.report(); }
  TissueView view() override { return TissueView(model_); }
  std::unique_ptr<HapticServo> make_servo(const std::vector<Tool>& tools, const ServoOptions& options) override {
    return std::make_unique<HapticServo>(model_, tools, options);
  }
  void set_gravity(const Vector3& gravity) override {
    gravity_ = gravity;
    model_.set_gravity(gravity);
  }

  double work_interval() const override {
    if constexpr (requires { model_.step(); })
      return model_.step();
    else
      return HasBackgroundWork<Model> ? 0.016 : infinity;
  }
  void work() override { background_work(); }
  std::unique_ptr<BackgroundWorker> start_worker() override { return std::make_unique<BackgroundWorker>(*this); }

  // For BackgroundWorker
  auto background_work() {
    if constexpr (requires { model_.step(); }) {
      if (conditions_at_) model_.set_conditions(conditions_at_(time_).gravity(gravity_));
      time_ += model_.step();
    }
    return model_.background_work();
  }
  auto report_slow(bool slow) noexcept { return model_.report_slow(slow); }
  auto report_failed(bool failed) noexcept { return model_.report_failed(failed); }

  bool draw(const ServoSnapshot& snapshot, Field field, DrawnSurface& surface) override {
    if (drawn_.update()) ++revision_;
    if (surface.revision != revision_) {  // each of several surfaces follows at its own time
      surface.triangles = drawn_.triangles();
      surface.revision = revision_;
    }
    const auto points = static_cast<std::size_t>(drawn_.point_count());
    surface.positions.resize(3 * points);
    surface.normals.resize(3 * points);
    surface.values.resize(points);
    if (!drawn_.read_surface(snapshot.vertex_forces(), surface.positions, surface.normals)) return false;
    if (!drawn_.read_field(field_at_nodes(field), surface.values)) return false;
    if constexpr (requires { drawn_.exposed(); })
      for (std::size_t i = 0; i < points; ++i)
        if (drawn_.exposed()[i] != 0) surface.values[i] = DrawnSurface::wound;
    return true;
  }
  bool has(Field field) const override { return linear_stress || field == Field::displacement; }

  /// By the corners; of the mesh before cuts.
  double least_volume_ratio(const ServoSnapshot& snapshot) override {
    VectorX u;
    model_.displacement_with(snapshot.vertex_forces(), u);
    const auto& mesh = model_.mesh();
    double least = infinity;
    for (Index e = 0; e < mesh.element_count(); ++e) {
      Matrix3 rest, now;
      for (int k = 0; k < 3; ++k) {
        const Index node = mesh.element_node(e, k + 1), first = mesh.element_node(e, 0);
        rest.col(k) = mesh.position(static_cast<NodeId>(node)) - mesh.position(static_cast<NodeId>(first));
        now.col(k) = rest.col(k) + u.template segment<3>(3 * node) - u.template segment<3>(3 * first);
      }
      least = std::min(least, now.determinant() / rest.determinant());
    }
    return least;
  }

  void write_vtu(const std::string& path, const ServoSnapshot& snapshot) override {
    VectorX u;
    model_.displacement_with(snapshot.vertex_forces(), u);
    io::VtuFields fields;  // a cut adds nodes; the file has the mesh as it was before
    fields.at_nodes = {{"displacement [m]", u.head(3 * model_.mesh().node_count())}};
    if constexpr (linear_stress) {
      recover_stress(model_.body(), u, stress_);
      fields.at_nodes.push_back({"von Mises stress [Pa]", stress_.von_mises_nodes});
    }
    io::write_vtu(path, model_.mesh(), fields);
  }

  DrawnSurface region(const std::string& name) const override {
    DrawnSurface surface;
    for (const auto& face : faces_around(name)) {
      const auto first = static_cast<int>(surface.positions.size() / 3);
      std::array<Vector3, 3> corner;
      for (std::size_t k = 0; k < 3; ++k) corner[k] = model_.to_world() * model_.mesh().position(face[k]);
      const Vector3 normal = (corner[1] - corner[0]).cross(corner[2] - corner[0]).normalized();
      for (const Vector3& x : corner)
        for (int c = 0; c < 3; ++c) {
          surface.positions.push_back(static_cast<float>(x[c]));
          surface.normals.push_back(static_cast<float>(normal[c]));
        }
      surface.triangles.push_back({first, first + 1, first + 2});
    }
    surface.values.assign(surface.positions.size() / 3, 0.0F);
    surface.revision = 1;
    return surface;
  }

 private:
  const VectorX& field_at_nodes(Field field) {
    const VectorX& u = drawn_.displacement();
    if constexpr (linear_stress)
      if (field == Field::von_mises) {
        recover_stress(model_.body(), u, stress_);
        return stress_.von_mises_nodes;
      }
    length_.resize(u.size() / 3);
    for (Index i = 0; i < length_.size(); ++i) length_[i] = u.template segment<3>(3 * i).norm();
    return length_;
  }

  /// Faces of elements of the region that no other element of it has; corners only.
  std::vector<std::array<NodeId, 3>> faces_around(const std::string& name) const {
    std::map<std::array<NodeId, 3>, std::array<NodeId, 3>> open;
    const auto& mesh = model_.mesh();
    constexpr int corners[4][3] = {{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {0, 3, 2}};  // of a tetrahedron, outward
    for (Index e = 0; e < mesh.element_count(); ++e) {
      if (mesh.region_name(mesh.region(e)) != name) continue;
      for (const auto& c : corners) {
        const std::array<NodeId, 3> face{mesh.element_node(e, c[0]), mesh.element_node(e, c[1]),
                                         mesh.element_node(e, c[2])};
        auto key = face;
        std::ranges::sort(key);
        if (!open.emplace(key, face).second) open.erase(key);
      }
    }
    std::vector<std::array<NodeId, 3>> faces;
    for (const auto& [key, face] : open) faces.push_back(face);
    return faces;
  }

  Model model_;
  VisualSurface<Model> drawn_;
  unsigned long revision_ = 1;  // of the triangles
  std::function<Scene(double)> conditions_at_;
  Vector3 gravity_ = Vector3::Zero();
  double time_ = 0.0;
  VectorX length_;
  StressField stress_;
};

/// Options of the set-up; `can_measure`: the composition measures the error of its forces.
SetupOptions setup_options(const Tuning& tuning, bool can_measure);
/// Conditions with the gravity of the tuning.
Scene tuned_conditions(const TouchScene& scene, const Tuning& tuning);

/// One function per file, so that the compositions compile beside each other.
std::unique_ptr<Organ> make_tet4(const TouchScene& scene, const Tuning& tuning);
std::unique_ptr<Organ> make_smoothed(const TouchScene& scene, const Tuning& tuning);
std::unique_ptr<Organ> make_tet10(const TouchScene& scene, const Tuning& tuning);
std::unique_ptr<Organ> make_quasi_newton(const TouchScene& scene, const Tuning& tuning);
std::unique_ptr<Organ> make_cuttable(const TouchScene& scene, const Tuning& tuning);
std::unique_ptr<Organ> make_beating(const TouchScene& scene, const Tuning& tuning);

}  // namespace live
