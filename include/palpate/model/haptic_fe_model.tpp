// Definitions of haptic_fe_model.hpp: templates, for elements and materials of any type.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/model/element_body.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/solver_recipe.hpp>
#include <palpate/model/stage_timer.hpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

template <Element E>
const ElementBody<E>& element_body(const ElasticBody& body) noexcept {
  return static_cast<const ElementBody<E>&>(body);
}

template <Element E, class Assembly>
AnyStiffness make_stiffness(const ElasticBody& body, const SetupLimits& limits) {
  return AnyStiffness(Assembly::make(element_body<E>(body).body(), limits));
}

/// Admits a mesh and evaluates its materials. Reports what admission found. Throws what materials_by_region and admit
/// throw.
template <Element E, LinearMaterial M, MeshOf<E> Given>
AdmittedBody admit_body(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                        const AdmissionPolicy& policy, const SetupLimits& limits, SetupReport& report) {
  const std::vector<M> by_region = materials_by_region(mesh, materials);
  limits.advance("admission", 0.0);
  Admitted<E> admitted = [&] {
    const StageTimer timer(report, "admission");
    // A mesh that lists its groups keeps all, so that later conditions may name any.
    if constexpr (ListsGroups<Given>)
      return admit<E>(mesh, policy);
    else
      return admit<E>(mesh, policy, scene.group_names());
  }();
  report_admission(admitted, report);
  OriginalIds ids = original_ids(admitted);
  const ScopedIdTranslation translation(ids);
  const Vector3 origin = 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max);
  for (Vector3& x : admitted.mesh.positions) x -= origin;
  auto body = std::make_unique<ElementBody<E>>(make_body(std::move(admitted.mesh), by_region), origin);
  return {std::move(body), std::move(admitted.node_map), std::move(ids), origin};
}

}  // namespace detail

template <Element E, LinearMaterial M, SolverPolicy Solver>
template <MeshOf<E> Mesh>
HapticFEModel<E, M, Solver>::HapticFEModel(const Mesh& mesh, const Scene& scene, const M& material,
                                           const SetupOptions& options)
    : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}

template <Element E, LinearMaterial M, SolverPolicy Solver>
template <MeshOf<E> Mesh>
HapticFEModel<E, M, Solver>::HapticFEModel(const Mesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                                           const SetupOptions& options)
    : Tissue(options) {
  this->set_up(scene,
               detail::admit_body<E>(mesh, scene, materials, options.admission, this->limits(), this->setup_report()),
               detail::make_stiffness<E, typename Traits::Assembly>, solver_recipe<Solver>(), options);
}

template <Element E, LinearMaterial M, SolverPolicy Solver>
const Mesh<E>& HapticFEModel<E, M, Solver>::mesh() const noexcept {
  return body().mesh;
}
template <Element E, LinearMaterial M, SolverPolicy Solver>
const Body<E>& HapticFEModel<E, M, Solver>::body() const noexcept {
  return detail::element_body<E>(this->elastic_body()).body();
}
template <Element E, LinearMaterial M, SolverPolicy Solver>
const std::vector<BoundaryFace>& HapticFEModel<E, M, Solver>::boundary() const noexcept {
  return detail::element_body<E>(this->elastic_body()).boundary();
}

}}  // namespace palpate

#if !PALPATE_HEADER_ONLY
#include <palpate/model/shipped.hpp>
#endif
