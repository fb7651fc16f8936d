// A mesh with materials that hold at any strain.
#pragma once

#include <palpate/assembly/body.hpp>

namespace palpate::inline PALPATE_ABI {

/// An admitted mesh, a law per region, and the body as it is at small strain: what stiffness at rest, mass and dead
/// loads come from.
template <Element E, HyperelasticMaterial M>
struct HyperelasticBody {
  Body<E> rest;
  std::vector<M> laws;  ///< by region

  const M& law_of(Index e) const noexcept { return laws[rest.region_of(e)]; }
};

/// By region number.
template <Element E, HyperelasticMaterial M>
HyperelasticBody<E, M> make_hyperelastic_body(Mesh<E> mesh, std::vector<M> by_region) {
  HyperelasticBody<E, M> body{{std::move(mesh), {}, {}, {}}, std::move(by_region)};
  for (const M& law : body.laws) {
    body.rest.elasticity.push_back(law.rest_elasticity());
    body.rest.density.push_back(law.density);
  }
  body.rest.initial_strain.assign(body.laws.size(), Vector6::Zero());
  return body;
}

/// With materials by name; throws as materials_by_region.
template <Element E, HyperelasticMaterial M>
HyperelasticBody<E, M> make_hyperelastic_body(Mesh<E> mesh, const RegionMaterials<M>& materials) {
  std::vector<M> by_region = materials_by_region(mesh, materials);
  return make_hyperelastic_body(std::move(mesh), std::move(by_region));
}

}  // namespace palpate::inline PALPATE_ABI
