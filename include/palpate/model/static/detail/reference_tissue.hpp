// A linear tissue on a finer mesh, for measurements at set-up.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/static/detail/solver_recipe.hpp>
#include <palpate/model/static/linear_tissue.hpp>

#include <numeric>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Smoothed<Tet4> with the elasticity of every region, and Condensed<SelectiveInverse>. The mesh needs no admission.
class ReferenceTissue : public LinearTissue<double> {
 public:
  /// Throws the errors of the set-up of a model.
  ReferenceTissue(Mesh<Tet4> mesh, std::vector<Matrix6> elasticity, const Scene& scene, const SetupOptions& options);
};

inline ReferenceTissue::ReferenceTissue(Mesh<Tet4> mesh, std::vector<Matrix6> elasticity, const Scene& scene,
                                        const SetupOptions& options)
    : LinearTissue<double>(options) {
  using E = Smoothed<Tet4>;
  const std::size_t regions = elasticity.size();
  AdmittedBody admitted;
  admitted.node_map.resize(mesh.positions.size());
  std::iota(admitted.node_map.begin(), admitted.node_map.end(), 0);
  admitted.origin = Vector3::Zero();
  Body<E> body{copy_mesh<E>(mesh), std::move(elasticity), std::vector<double>(regions, 0.0),
               std::vector<Vector6>(regions, Vector6::Zero())};
  admitted.body = std::make_unique<ElementBody<E>>(std::move(body));
  set_up(scene, std::move(admitted), make_stiffness<E, Assembled>, solver_recipe<Condensed<SelectiveInverse>>(),
         options);
}

}}}  // namespace palpate::detail
