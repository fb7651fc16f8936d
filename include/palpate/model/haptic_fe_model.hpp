// The composition: element, material and solver make a tissue that can be touched.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/model/elastic_body.hpp>
#include <palpate/model/linear_tissue.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/stage_timer.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Linear static tissue. `E` is the element, `M` the material, `Solver` a policy of model/policies.hpp; assembly,
/// quadrature and condensation come with them. The model is prepared once and copies what it needs from mesh and scene.
/// Afterwards it changes through named calls only (loads, prescribed values, gravity, pose, reset), none of which
/// refactorises; none may run while a tick does. Satisfies TissueModel. What does not depend on the types is in its
/// base, LinearTissue.
///
/// Frames: nodes, forces and displacements are in the model's frame, which is the mesh's; `set_pose` places it in the
/// world of the tools.
template <Element E, LinearMaterial M, SolverPolicy Solver = Condensed<SelectiveInverse>>
class HapticFEModel : public LinearTissue<typename SolverTraits<Solver>::Scalar> {
  using Tissue = LinearTissue<typename SolverTraits<Solver>::Scalar>;

 public:
  static_assert(has_triangulated_faces<E>(),
                "palpate: tools touch triangles; give the element's Face a list `triangles` of its nodes, like Tri6");
  using ElementType = E;
  using Traits = SolverTraits<Solver>;

  /// One material everywhere. Throws SetupError; see docs/errors.md for the kinds.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const M& material, const SetupOptions& options = {})
      : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}

  /// One material per region.
  template <MeshOf<E> Mesh>
  HapticFEModel(const Mesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                const SetupOptions& options = {})
      : Tissue(options) {
    const std::vector<M> by_region = materials_by_region(mesh, materials);
    this->limits().advance("admission", 0.0);
    Admitted<E> admitted = [&] {
      const StageTimer timer(this->setup_report(), "admission");
      // A mesh that lists its groups keeps all, so that later conditions may name any.
      if constexpr (ListsGroups<Mesh>)
        return admit<E>(mesh, options.admission);
      else
        return admit<E>(mesh, options.admission, scene.group_names());
    }();
    report_admission(admitted, this->setup_report());
    this->place_nodes(scene, std::move(admitted.node_map), 0.5 * (admitted.admitted.box_min + admitted.admitted.box_max),
                      admitted.mesh.positions);
    this->prepare(std::make_unique<ElementBody<E>>(make_body(std::move(admitted.mesh), by_region)), make_stiffness,
                  solver_recipe<Solver>(), options);
  }

  /// The admitted mesh, in the frame of `origin()`.
  const Mesh<E>& mesh() const noexcept { return body().mesh; }
  const Body<E>& body() const noexcept { return element_body(this->elastic_body()).body(); }
  const std::vector<BoundaryFace<E>>& boundary() const noexcept {
    return element_body(this->elastic_body()).boundary();
  }

 private:
  static const ElementBody<E>& element_body(const ElasticBody& body) noexcept {
    return static_cast<const ElementBody<E>&>(body);
  }
  static AnyStiffness make_stiffness(const ElasticBody& body, const SetupLimits& limits) {
    return AnyStiffness(Traits::Assembly::make(element_body(body).body(), limits));
  }
};

}}  // namespace palpate
