// Makes the admitted body of a linear model from a mesh as given and its materials.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/model/detail/admitted_mesh.hpp>
#include <palpate/model/detail/element_body.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Admits a mesh and evaluates its materials. Reports what admission found. Throws the errors of materials_by_region
/// and admit.
template <Element E, LinearMaterial M, MeshOf<E> Given>
AdmittedBody admit_body(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                        const AdmissionPolicy& policy, const SetupLimits& limits, SetupReport& report) {
  const std::vector<M> by_region = materials_by_region(mesh, materials);
  AdmittedMesh<E> admitted = admit_mesh<E>(mesh, scene, policy, limits, report);
  const ScopedIdTranslation translation(admitted.ids);
  auto body = std::make_unique<ElementBody<E>>(make_body(std::move(admitted.mesh), by_region), admitted.origin);
  return {std::move(body), std::move(admitted.node_map), std::move(admitted.ids), admitted.origin};
}

}}}  // namespace palpate::detail
