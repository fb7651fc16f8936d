// Makes the admitted mesh or body of a model from a mesh as given, with the origin at the centre of its bounding box.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// An admitted mesh, translated so that the centre of its bounding box is the origin.
template <Element E>
struct AdmittedMesh {
  Mesh<E> mesh;
  std::vector<NodeId> node_map;  ///< new id of every node as given, -1 for dropped nodes
  OriginalIds ids;               ///< ids of its nodes and elements in the mesh as given
  Vector3 origin;                ///< origin of its frame, in the frame of the mesh as given [m]
};

/// Admits a mesh and reports what admission found. Throws the errors of admit.
template <Element E, MeshOf<E> Given>
AdmittedMesh<E> admit_mesh(const Given& mesh, const Scene& scene, const AdmissionPolicy& policy,
                           const SetupLimits& limits, SetupReport& report) {
  limits.advance("admission", 0.0);
  Admitted<E> admitted = [&] {
    const StageTimer timer(report, "admission");
    // A mesh that lists its groups keeps all of them, so that later conditions may name any group.
    if constexpr (ListsGroups<Given>)
      return admit<E>(mesh, policy);
    else
      return admit<E>(mesh, policy, scene.group_names());
  }();
  report_admission(admitted, report);
  OriginalIds ids = original_ids(admitted);
  const Vector3 origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
  for (Vector3& x : admitted.mesh.positions) x -= origin;
  return {std::move(admitted.mesh), std::move(admitted.node_map), std::move(ids), origin};
}

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
