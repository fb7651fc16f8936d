// A mesh with the elasticity, density and initial strain of its regions, ready for integration.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/mesh/detail/fibres.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// An admitted mesh and, per region, elasticity matrix [Pa], density [kg/m^3] and initial strain. If fibre directions
/// differ between elements there are more elasticity matrices than regions, and `materials` gives the matrix of each
/// element.
template <Element E>
struct Body {
  Mesh<E> mesh;
  std::vector<Matrix6> elasticity;
  std::vector<double> density;
  std::vector<Vector6> initial_strain;
  std::vector<std::int32_t> materials{};  ///< per element, index into `elasticity`; empty: the region

  std::size_t region_of(Index e) const noexcept { return static_cast<std::size_t>(mesh.region(e)); }
  std::size_t material_of(Index e) const noexcept {
    return materials.empty() ? region_of(e) : static_cast<std::size_t>(materials[static_cast<std::size_t>(e)]);
  }
  const Matrix6& elasticity_of(Index e) const noexcept { return elasticity[material_of(e)]; }
};

namespace detail {

/// Throws with the id of one element.
[[noreturn]] PALPATE_COLD void raise_element(SetupErrorKind kind, Index e, const char* what);

/// Elements with one integration point, so constant gradients (Tet4).
template <class E>
concept ConstantGradient = Element<E> && E::Quadrature::points.size() == 1;

/// Geometry of element e [1/m, m^3]. Throws inverted_element for a negative volume, non_finite for a volume that is
/// zero or NaN.
template <ConstantGradient E>
PointGeometry<E> constant_geometry(const Mesh<E>& mesh, Index e) {
  constexpr auto point = E::Quadrature::points[0];
  const PointGeometry<E> g = point_geometry<E>(element_nodes<E>(mesh, e), reference_point(point), point.weight);
  if (g.volume < 0.0) raise_element(SetupErrorKind::inverted_element, e, "has a negative volume");
  if (!(g.volume > 0.0) || !all_finite(g.gradient))
    raise_element(SetupErrorKind::non_finite, e, "has a stiffness that is not finite");
  return g;
}

/// Throws for a material that fails its own check(); the error names the region by number and name.
template <Material M, MeshView Mesh>
void require_admissible(const M& material, const Mesh& mesh, int region) {
  auto problem = material.check();
  if (!problem) return;
  problem->what += " in region '" + std::string(mesh.region_name(region)) + "'";
  problem->ids = {region};
  problem->count = 1;
  raise(std::move(*problem));
}

/// Throws unless there is one admissible material per region, by region number: missing_material for too few,
/// bad_argument for too many, or the problem of a material's check().
template <Material M, MeshView Mesh>
void require_material_per_region(const std::vector<M>& by_region, const Mesh& mesh) {
  const auto regions = static_cast<std::size_t>(mesh.region_count());
  if (by_region.size() != regions)
    raise(by_region.size() < regions ? SetupErrorKind::missing_material : SetupErrorKind::bad_argument,
          std::to_string(by_region.size()) + " materials for " + std::to_string(regions) + " regions",
          "Give one material per region, in the order of the mesh");
  for (std::size_t r = 0; r < regions; ++r) require_admissible(by_region[r], mesh, static_cast<int>(r));
}

/// The material of every region of a mesh, in region order. Throws missing_material, unknown_group (a material for a
/// region that does not exist) or the problem of a material's check(), with the region's number and name.
template <Material M, MeshView Mesh>
std::vector<M> materials_by_region(const Mesh& mesh, const RegionMaterials<M>& materials) {
  std::vector<M> result;
  for (const auto& [name, material] : materials) {
    bool known = name == everywhere;
    for (int r = 0; r < mesh.region_count(); ++r) known = known || mesh.region_name(r) == name;
    if (!known)
      raise(SetupErrorKind::unknown_group,
            "there is a material for region '" + name + "', but the mesh has no such region");
  }
  for (int r = 0; r < mesh.region_count(); ++r) {
    const M* named = nullptr;
    const M* any = nullptr;
    for (const auto& [name, material] : materials) {
      if (named == nullptr && name == mesh.region_name(r)) named = &material;
      if (any == nullptr && name == everywhere) any = &material;
    }
    if (named == nullptr) named = any;
    if (named == nullptr)
      raise(SetupErrorKind::missing_material, "region '" + std::string(mesh.region_name(r)) + "' has no material",
            "Give one material per region");
    require_admissible(*named, mesh, r);
    result.push_back(*named);
  }
  return result;
}

/// Evaluates the elasticity of every element along its own fibre, elasticity(region, fibre): 292 bytes per element,
/// less if consecutive elements have the same region and fibre.
template <Element E, class Elasticity>
void add_fibre_laws(Body<E>& body, Elasticity elasticity) {
  const Mesh<E>& mesh = body.mesh;
  body.elasticity.clear();
  body.materials.reserve(static_cast<std::size_t>(mesh.element_count()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const bool same = e > 0 && mesh.region(e) == mesh.region(e - 1) && mesh.fibre(e) == mesh.fibre(e - 1);
    if (!same) body.elasticity.push_back(elasticity(body.region_of(e), mesh.fibre(e)));
    body.materials.push_back(static_cast<std::int32_t>(body.elasticity.size()) - 1);
  }
}

}  // namespace detail

/// An admitted mesh with one material per region, by region number, without initial strain. If the mesh has fibres and
/// the material uses them, every element gets its own elasticity. Throws as require_material_per_region, and
/// bad_argument for fibres that are not unit vectors.
template <Element E, LinearMaterial M>
Body<E> make_body(Mesh<E> mesh, const std::vector<M>& by_region) {
  detail::require_material_per_region(by_region, mesh);
  Body<E> body{std::move(mesh), {}, {}, {}};
  for (const M& material : by_region) {
    body.elasticity.push_back(material.elasticity());
    body.density.push_back(material.density);
  }
  body.initial_strain.assign(by_region.size(), Vector6::Zero());
  if constexpr (FibreMaterial<M>) {
    detail::require_unit_fibres(body.mesh);
    if (body.mesh.has_fibres())
      detail::add_fibre_laws(body, [&](std::size_t r, const Vector3& fibre) { return by_region[r].elasticity(fibre); });
  }
  return body;
}

/// The same with materials by region name; throws as materials_by_region.
template <Element E, LinearMaterial M>
Body<E> make_body(Mesh<E> mesh, const RegionMaterials<M>& materials) {
  const std::vector<M> by_region = detail::materials_by_region(mesh, materials);
  return make_body(std::move(mesh), by_region);
}

/// The same with one material for all regions.
template <Element E, LinearMaterial M>
Body<E> make_body(Mesh<E> mesh, const M& material) {
  return make_body(std::move(mesh), RegionMaterials<M>{{everywhere, material}});
}

namespace detail {

inline void raise_element(SetupErrorKind kind, Index e, const char* what) {
  raise_at(SetupIds::elements, e, kind, std::string("an element ") + what);
}

}  // namespace detail

}}  // namespace palpate
