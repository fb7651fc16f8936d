// A mesh with its materials evaluated: what is integrated over.
#pragma once

#include <palpate/concepts/material.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>

#include <utility>

namespace palpate::inline PALPATE_ABI {

/// One material per region, by name; the name `everywhere` stands for all regions not named.
template <Material M>
using RegionMaterials = std::vector<std::pair<std::string, M>>;

/// An admitted mesh and, per region, elasticity matrix [Pa], density [kg/m^3] and initial strain.
template <Element E>
struct Body {
  Mesh<E> mesh;
  std::vector<Matrix6> elasticity;
  std::vector<double> density;
  std::vector<Vector6> initial_strain;

  std::size_t region_of(Index e) const noexcept { return static_cast<std::size_t>(mesh.region(e)); }
  const Matrix6& elasticity_of(Index e) const noexcept { return elasticity[region_of(e)]; }
};

/// Refuses with the id of one element.
[[noreturn]] PALPATE_COLD inline void raise_element(SetupErrorKind kind, Index e, const char* what) {
  SetupProblem p;
  p.kind = kind;
  p.what = "element " + std::to_string(e) + ' ' + what;
  p.ids = {e};
  p.count = 1;
  raise(std::move(p));
}

/// The material of every region of a mesh, in region order. Throws missing_material, unknown_group (a material for a
/// region that does not exist) or whatever the material's own check() says, with the region's number and name.
template <LinearMaterial M, MeshView Mesh>
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
    const auto named =
        std::ranges::find(materials, std::string(mesh.region_name(r)), &std::pair<std::string, M>::first);
    const auto any = std::ranges::find(materials, everywhere, &std::pair<std::string, M>::first);
    const auto it = named != materials.end() ? named : any;
    if (it == materials.end())
      raise(SetupErrorKind::missing_material, "region '" + std::string(mesh.region_name(r)) + "' has no material",
            "Give one per region");
    if (auto problem = it->second.check()) {
      problem->what += " in region '" + std::string(mesh.region_name(r)) + "'";
      problem->ids = {r};
      problem->count = 1;
      raise(std::move(*problem));
    }
    result.push_back(it->second);
  }
  return result;
}

/// An admitted mesh with one material per region, by region number, without initial strain.
template <Element E, LinearMaterial M>
Body<E> make_body(Mesh<E> mesh, const std::vector<M>& by_region) {
  Body<E> body{std::move(mesh), {}, {}, {}};
  for (const M& material : by_region) {
    body.elasticity.push_back(material.elasticity());
    body.density.push_back(material.density);
  }
  body.initial_strain.assign(by_region.size(), Vector6::Zero());
  return body;
}

/// The same with materials by name; throws as materials_by_region.
template <Element E, LinearMaterial M>
Body<E> make_body(Mesh<E> mesh, const RegionMaterials<M>& materials) {
  const std::vector<M> by_region = materials_by_region(mesh, materials);
  return make_body(std::move(mesh), by_region);
}

/// The same with one material everywhere.
template <Element E, LinearMaterial M>
Body<E> make_body(Mesh<E> mesh, const M& material) {
  return make_body(std::move(mesh), RegionMaterials<M>{{everywhere, material}});
}

}  // namespace palpate::inline PALPATE_ABI
