// A linear elastic body of one element type.
#pragma once

#include <palpate/assembly/load_vector.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/mesh/detail/mechanisms.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/project_half_space.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A body of elements E.
template <Element E>
class ElementBody final : public ElasticBody {
 public:
  /// `origin` is the origin of the body frame, in the frame of the mesh as given [m].
  explicit ElementBody(Body<E> body, const Vector3& origin = Vector3::Zero());

  const Body<E>& body() const noexcept { return body_; }
  const std::vector<BoundaryFace>& boundary() const noexcept { return boundary_; }

  const std::vector<Vector3>& positions() const noexcept override;
  const std::vector<std::string>& region_names() const noexcept override;
  const std::vector<double>& densities() const noexcept override;
  void require_constrained(const EssentialConditions& conditions) const override;
  EssentialConditions conditions(const Scene& scene) const override;
  Touchable touchable(const Scene& scene) const override;
  std::vector<NodeId> rendered(const Scene& scene) const override;
  VectorX applied_load(const Scene& scene) const override;
  std::vector<Vector6> initial_strains(const Scene& scene) const override;
  VectorX initial_strain_load(const std::vector<Vector6>& strains) const override;
  void swap_initial_strains(std::vector<Vector6>& strains) noexcept override;
  VectorX nodal_mass() const override;
  double strain_energy(const VectorX& u) const override;
  MeshRef mesh() const noexcept override { return mesh_ref(body_.mesh); }
  std::span<const Matrix6> elasticities() const noexcept override { return body_.elasticity; }
  int elasticity_of(Index e) const noexcept override { return static_cast<int>(body_.material_of(e)); }
  std::vector<ContactMaterial> contact_materials(std::span<const Index> elements) const override;
  ProjectedHalfSpace half_space(std::span<const NodeId> touched, const EssentialConditions& conditions,
                                const SetupLimits& limits) const override;
  CacheKey key() const noexcept override;
  void report_locking(SetupReport& report) const override;

 private:
  Body<E> body_;
  std::vector<BoundaryFace> boundary_;
  Vector3 origin_;
};

template <Element E>
const Body<E>& body_of(const ElasticBody& body) noexcept {
  return static_cast<const ElementBody<E>&>(body).body();
}
template <Element E>
const Mesh<E>& mesh_of(const ElasticBody& body) noexcept {
  return body_of<E>(body).mesh;
}
template <Element E>
const std::vector<BoundaryFace>& boundary_of(const ElasticBody& body) noexcept {
  return static_cast<const ElementBody<E>&>(body).boundary();
}

/// The isotropic materials of elements, for the contact surface before them; unknown where they are not isotropic.
template <Element E>
std::vector<ContactMaterial> contact_materials(const Body<E>& body, std::span<const Index> elements) {
  std::vector<ContactMaterial> materials;
  for (const Index e : elements) {
    ContactMaterial& material = materials.emplace_back();
    if (const auto lame = lame_constants(body.elasticity_of(e))) {
      const double sum = lame->lambda + lame->mu;
      material = {4.0 * lame->mu * sum / (sum + lame->mu), 0.5 * lame->lambda / sum};
    }
  }
  return materials;
}

template <Element E>
ElementBody<E>::ElementBody(Body<E> body, const Vector3& origin)
    : body_(std::move(body)), boundary_(extract_boundary<E>(body_.mesh)), origin_(origin) {}

template <Element E>
const std::vector<Vector3>& ElementBody<E>::positions() const noexcept {
  return body_.mesh.positions;
}
template <Element E>
const std::vector<std::string>& ElementBody<E>::region_names() const noexcept {
  return body_.mesh.region_names;
}
template <Element E>
const std::vector<double>& ElementBody<E>::densities() const noexcept {
  return body_.density;
}
template <Element E>
void ElementBody<E>::require_constrained(const EssentialConditions& conditions) const {
  detail::require_constrained(body_.mesh, conditions.constrained, origin_);
}
template <Element E>
EssentialConditions ElementBody<E>::conditions(const Scene& scene) const {
  return resolve_essential(mesh_ref(body_.mesh), boundary_, scene);
}
template <Element E>
Touchable ElementBody<E>::touchable(const Scene& scene) const {
  return resolve_touchable(mesh_ref(body_.mesh), boundary_, scene);
}
template <Element E>
std::vector<NodeId> ElementBody<E>::rendered(const Scene& scene) const {
  return resolve_rendered(mesh_ref(body_.mesh), boundary_, scene);
}
template <Element E>
VectorX ElementBody<E>::applied_load(const Scene& scene) const {
  return detail::applied_load(body_, boundary_, scene);
}
template <Element E>
std::vector<Vector6> ElementBody<E>::initial_strains(const Scene& scene) const {
  return initial_strains_by_region(body_.mesh, scene);
}
template <Element E>
VectorX ElementBody<E>::initial_strain_load(const std::vector<Vector6>& strains) const {
  return detail::initial_strain_load(body_, strains);
}
template <Element E>
void ElementBody<E>::swap_initial_strains(std::vector<Vector6>& strains) noexcept {
  body_.initial_strain.swap(strains);
}
template <Element E>
VectorX ElementBody<E>::nodal_mass() const {
  return palpate::nodal_mass(body_);
}
template <Element E>
double ElementBody<E>::strain_energy(const VectorX& u) const {
  return palpate::strain_energy(body_, u);
}
template <Element E>
std::vector<ContactMaterial> ElementBody<E>::contact_materials(std::span<const Index> elements) const {
  return detail::contact_materials(body_, elements);
}
template <Element E>
ProjectedHalfSpace ElementBody<E>::half_space(std::span<const NodeId> touched, const EssentialConditions& conditions,
                                              const SetupLimits& limits) const {
  std::vector<std::uint8_t> constrained(body_.mesh.positions.size(), 0);
  for (std::size_t i = 0; i < 3 * constrained.size(); ++i)
    if (conditions.is_constrained(static_cast<Index>(i)))
      constrained[i / 3] = static_cast<std::uint8_t>(constrained[i / 3] | 1u << i % 3);
  return project_half_space(body_, boundary_, touched, constrained, nullptr, limits);
}
template <Element E>
CacheKey ElementBody<E>::key() const noexcept {
  return body_key(body_);
}
template <Element E>
void ElementBody<E>::report_locking(SetupReport& report) const {
  detail::report_locking<E>(body_.elasticity, report);
}

}}}  // namespace palpate::detail
