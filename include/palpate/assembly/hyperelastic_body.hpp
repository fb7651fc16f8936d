// A mesh with materials for any strain.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/mesh/detail/fibres.hpp>
#include <palpate/mesh/mesh.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// The material of one element: along the element's own fibres if there are any, otherwise as given.
template <HyperelasticMaterial M>
class ElementMaterial {
 public:
  ElementMaterial(const M& material, const Vector3* fibre) noexcept : material_(material) {
    if (fibre == nullptr) return;
    along_ = {(*fibre)[0], (*fibre)[1], (*fibre)[2]};
    has_fibre_ = true;
  }
  double energy(const Tensor3<double>& f) const noexcept {
    if constexpr (FibreHyperelasticMaterial<M>)
      if (has_fibre_) return material_.energy(f, along_);
    return material_.energy(f);
  }
  Tensor3<double> stress(const Tensor3<double>& f) const noexcept {
    if constexpr (FibreHyperelasticMaterial<M>)
      if (has_fibre_) return material_.stress(f, along_);
    return material_.stress(f);
  }
  Matrix9 tangent(const Tensor3<double>& f) const noexcept {
    if constexpr (FibreHyperelasticMaterial<M>)
      if (has_fibre_) return material_.tangent(f, along_);
    return material_.tangent(f);
  }
  bool admits(const Tensor3<double>& f) const noexcept {
    if constexpr (FibreHyperelasticMaterial<M>)
      if (has_fibre_) return material_.admits(f, along_);
    return material_.admits(f);
  }

 private:
  const M& material_;
  Triple<double> along_{};
  bool has_fibre_ = false;
};

}  // namespace detail
/// A material for large strain, with or without viscoelastic history.
template <class M>
concept LargeStrainMaterial = HyperelasticMaterial<M> || ViscousMaterial<M>;

/// An admitted mesh, one material per region, and the body at small strain, which gives the stiffness at rest, the
/// mass and the dead loads.
template <Element E, LargeStrainMaterial M>
struct HyperelasticBody {
  Body<E> rest;
  std::vector<M> materials;  ///< by region

  /// The material of element e; an ElementMaterial with the direction of the element's fibres if the mesh has fibres
  /// and the material uses them. Refers to the body.
  decltype(auto) material_of(Index e) const noexcept {
    if constexpr (FibreHyperelasticMaterial<M>)
      return detail::ElementMaterial<M>(materials[rest.region_of(e)], uses_fibres() ? &rest.mesh.fibre(e) : nullptr);
    else
      return (materials[rest.region_of(e)]);
  }
  bool uses_fibres() const noexcept { return FibreHyperelasticMaterial<M> && rest.mesh.has_fibres(); }
};

/// Materials by region number. If the mesh has fibres and the material uses them, every element has its own direction,
/// normalised to the last bit. Throws as require_material_per_region, bad_argument for fibres that are not unit
/// vectors, and unsupported for a viscoelastic material whose base uses fibres.
template <Element E, LargeStrainMaterial M>
HyperelasticBody<E, M> make_hyperelastic_body(Mesh<E> mesh, std::vector<M> by_region) {
  detail::require_material_per_region(by_region, mesh);
  HyperelasticBody<E, M> body{{std::move(mesh), {}, {}, {}}, std::move(by_region)};
  for (const M& material : body.materials) {
    body.rest.elasticity.push_back(material.rest_elasticity());
    body.rest.density.push_back(material.density);
  }
  if constexpr (requires(const M& material) { material.base; } && !FibreHyperelasticMaterial<M>)
    if (FibreHyperelasticMaterial<decltype(M::base)> && body.rest.mesh.has_fibres())
      raise(SetupErrorKind::unsupported, "a viscoelastic material with a fibre direction per element",
            "Clear the mesh's fibres so that the material's own direction is used");
  body.rest.initial_strain.assign(body.materials.size(), Vector6::Zero());
  if constexpr (FibreHyperelasticMaterial<M>) {
    detail::require_unit_fibres(body.rest.mesh);
    for (Vector3& fibre : body.rest.mesh.fibres) fibre.normalize();
    if (body.rest.mesh.has_fibres())
      detail::add_fibre_laws(body.rest, [&](std::size_t r, const Vector3& a) {
        return body.materials[r].rest_elasticity(Triple<double>{a[0], a[1], a[2]});
      });
  }
  return body;
}

namespace detail {

/// For forces that support one fibre direction per region only: throws for a material with fibres on a mesh with fibre
/// directions.
template <Element E, HyperelasticMaterial M>
void require_no_fibres(const HyperelasticBody<E, M>& body) {
  if (body.uses_fibres())
    raise(SetupErrorKind::unsupported, "a batched force with a fibre direction per element",
          "Use LargeStrain, or clear the mesh's fibres so that the material's own direction is used");
}

}  // namespace detail

/// With materials by region name; throws as materials_by_region.
template <Element E, LargeStrainMaterial M>
HyperelasticBody<E, M> make_hyperelastic_body(Mesh<E> mesh, const RegionMaterials<M>& materials) {
  std::vector<M> by_region = detail::materials_by_region(mesh, materials);
  return make_hyperelastic_body(std::move(mesh), std::move(by_region));
}

}}  // namespace palpate
