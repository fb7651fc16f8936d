// Tissue behind the interface of tissue.hpp, for a model of any type.
#pragma once

#include "laws.hpp"
#include "tissue.hpp"

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace cross {

/// The model of a scene as it is constructed. `Model` is a base of it where one has all that is used here: then this is
/// compiled once for all models on that base. `make` returns a new one; a pair calls it twice.
template <class Model>
class TissueOf final : public Tissue {
 public:
  using Make = std::function<std::shared_ptr<Model>()>;

  TissueOf(const Make& make, const Body& body, const TissueOptions& options)
      : member_(options.member), distance_(10.0 * body.size), model_(make()) {
    if (member_ == "pair") second_ = make();
    if (member_ == "adaptor") adaptor_.emplace(*model_);
    place();
  }

  std::unique_ptr<palpate::HapticServo> servo(const palpate::ToolList& tools,
                                              const palpate::ServoOptions& options) override {
    if (adaptor_) return std::make_unique<palpate::HapticServo>(*adaptor_, tools, options);
    palpate::TissueGroup group(*model_);
    if (second_) group.add(*second_);
    if (member_ == "group" || member_ == "pair") return std::make_unique<palpate::HapticServo>(group, tools, options);
    return std::make_unique<palpate::HapticServo>(*model_, tools, options);
  }
  double interval() const override {
    if constexpr (requires { model_->step(); })
      return model_->step();
    else
      return palpate::HasBackgroundWork<Model> ? 1e-3 : 0.0;
  }
  void work() override {
    work_of(*model_);
    if (second_) work_of(*second_);
  }
  std::unique_ptr<palpate::BackgroundWorker> worker() override {
    if (adaptor_) return std::make_unique<palpate::BackgroundWorker>(*adaptor_);
    return std::make_unique<palpate::BackgroundWorker>(*model_);
  }
  /// The pose of set_pose stays.
  void reset() override {
    model_->reset();
    if (second_) second_->reset();
    place();
  }
  void set_pose(const Eigen::Isometry3d& pose) override {
    pose_ = pose;
    place();
  }
  void set_conditions(const palpate::Scene& conditions) override {
    if constexpr (requires { model_->set_conditions(conditions); }) {
      model_->set_conditions(conditions);
      if (second_) second_->set_conditions(conditions);
    }
  }
  const palpate::SetupReport& report() const override { return model_->report(); }
  bool cut(const palpate::BladeSweep& sweep) override {
    if constexpr (requires { model_->cut(sweep); }) {
      model_->cut(sweep);
      return true;
    }
    return false;
  }
  std::vector<palpate::Vector3> surface(std::span<const palpate::VertexForce> forces) override {
    return pressed_surface(*model_, forces);
  }
  std::vector<double> facet_lengths() override { return longest_edges(model_->contact_surface()); }

 private:
  static void work_of(Model& model) {
    if constexpr (requires { model.step(); })
      model.background_work();
    else if constexpr (palpate::HasBackgroundWork<Model>)
      while (model.background_work().worked) continue;
  }
  static std::vector<double> longest_edges(const palpate::ContactSurface& surface) {
    std::vector<double> longest(static_cast<std::size_t>(surface.vertex_count()), 0.0);
    for (const palpate::Triangle& triangle : surface.triangles())
      for (std::size_t a = 0; a < 3; ++a) {
        const int i = triangle[a], j = triangle[(a + 1) % 3];
        const double length = (surface.position(i) - surface.position(j)).norm();
        for (const int v : {i, j})
          longest[static_cast<std::size_t>(v)] = std::max(longest[static_cast<std::size_t>(v)], length);
      }
    return longest;
  }
  template <class T>
  static std::vector<palpate::Vector3> pressed_surface(T& tissue, std::span<const palpate::VertexForce> forces) {
    std::vector<int> loaded;
    for (const palpate::VertexForce& f : forces) loaded.push_back(f.vertex);
    tissue.require_columns(loaded);
    std::vector<palpate::Vector3> surface;
    for (int i = 0; i < tissue.contact_surface().vertex_count(); ++i) {
      palpate::Vector3 x = tissue.contact_surface().position(i);
      for (const palpate::VertexForce& f : forces) x += tissue.compliance(i, f.vertex) * f.force.in_model_axes();
      surface.push_back(tissue.to_world() * x);
    }
    return surface;
  }
  /// The second one is beside the first, out of reach.
  void place() {
    if (!model_->pose().isApprox(pose_, 0.0)) model_->set_pose(pose_);
    if (second_) second_->set_pose(pose_ * Eigen::Translation3d(distance_, distance_, 0.0));
  }

  std::string member_;
  double distance_;
  std::shared_ptr<Model> model_, second_;  // shared: a base may have no public destructor
  Eigen::Isometry3d pose_ = Eigen::Isometry3d::Identity();
  std::optional<palpate::TissueAdaptor<Model>> adaptor_;
};

/// `word` of a solver and, where its models have parameters, `make<Model>(scene, body, construct)`: what
/// `construct(parameters)` returns.
template <class Solver>
struct SolverOf;

/// What TissueOf is compiled for: a base of the model that has all its hooks, or the model itself.
template <class Model>
struct Used {
  using Type = Model;
};
template <class E, class M, palpate::SolverPolicy Solver>
struct Used<palpate::HapticFEModel<E, M, Solver>> {
  using Type = palpate::LinearTissue<typename palpate::SolverTraits<Solver>::Scalar>;
};

/// Whether models of a solver take a cache file.
template <class Solver>
inline constexpr bool takes_cache = requires {
  palpate::SolverTraits<Solver>::cache_name;
};

/// Columns are computed in the tick that needs them, so that results do not depend on a thread.
inline palpate::SetupOptions setup_options(bool cached, const Scene& scene, const TissueOptions& given) {
  palpate::SetupOptions options;
  options.threads = given.threads;
  options.columns = palpate::ColumnFill::synchronous;
  if (cached) options.cache_file = given.cache_file;
  if (scene.measured || scene.corrected) options.force_error = palpate::measured_force_error();
  return options;
}

/// The mesh for elements E.
template <class E>
decltype(auto) mesh_of(const Body& body) {
  if constexpr (std::is_same_v<E, palpate::Tet10>)
    return palpate::promote<E>(body.tetrahedra);
  else if constexpr (std::is_same_v<E, palpate::Hex20>)
    return palpate::promote<E>(body.hexahedra);
  else if constexpr (E::nodes == 8)
    return (body.hexahedra);
  else
    return (body.tetrahedra);
}

template <class M>
palpate::RegionMaterials<M> materials_of(const Scene& scene, const Body& body, const TissueOptions& given,
                                         const std::vector<std::string>& regions) {
  palpate::RegionMaterials<M> materials;
  for (std::size_t r = 0; r < body.moduli.size(); ++r)
    materials.emplace_back(regions.at(r),
                           Law<M>::make({body.moduli[r], scene.poisson_ratio, body.density, given.axes}));
  return materials;
}

template <class E, class M, class Solver>
std::unique_ptr<Tissue> make_tissue(const Scene& scene, const Body& body, const TissueOptions& given) {
  using Model = palpate::HapticFEModel<E, M, Solver>;
  using Part = typename Used<Model>::Type;
  const palpate::SetupOptions options = setup_options(takes_cache<Solver>, scene, given);
  const auto& mesh = mesh_of<E>(body);
  const palpate::RegionMaterials<M> materials = materials_of<M>(scene, body, given, mesh.region_names);
  const auto make = [&] {
    std::shared_ptr<Part> model;
    if constexpr (!std::same_as<typename Model::Parameters, palpate::NoParameters>)
      model = SolverOf<Solver>::template make<Model>(scene, body, [&](const typename Model::Parameters& parameters) {
        return std::make_unique<Model>(mesh, body.conditions, materials, options, parameters);
      });
    else
      model = std::make_unique<Model>(mesh, body.conditions, materials, options);
    return model;
  };
  return std::make_unique<TissueOf<Part>>(make, body, given);
}

template <class E, class M, class Solver>
Composition composition() {
  return {element_word<E>, Law<M>::word, SolverOf<Solver>::word, make_tissue<E, M, Solver>};
}

}  // namespace cross
