// Definitions of haptic_fe_model.hpp: templates, for elements and materials of any type.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/model/detail/admitted_mesh.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/detail/solver_recipe.hpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

template <class E, class M, class Solver>
template <MeshOf<E> Mesh>
HapticFEModel<E, M, Solver>::HapticFEModel(const Mesh& mesh, const Scene& scene, const M& material,
                                           const SetupOptions& options)
    : HapticFEModel(mesh, scene, RegionMaterials<M>{{everywhere, material}}, options) {}

template <class E, class M, class Solver>
template <MeshOf<E> Mesh>
HapticFEModel<E, M, Solver>::HapticFEModel(const Mesh& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                                           const SetupOptions& options)
    : Tissue(options) {
  this->set_up(scene,
               detail::admit_body<E>(mesh, scene, materials, options.admission, this->limits(), this->setup_report()),
               detail::make_stiffness<E, typename Traits::Assembly>, detail::solver_recipe<Solver>(), options);
}

template <class E, class M, class Solver>
const Mesh<E>& HapticFEModel<E, M, Solver>::mesh() const noexcept {
  return body().mesh;
}
template <class E, class M, class Solver>
const Body<E>& HapticFEModel<E, M, Solver>::body() const noexcept {
  return detail::element_body<E>(this->elastic_body()).body();
}
template <class E, class M, class Solver>
const std::vector<BoundaryFace>& HapticFEModel<E, M, Solver>::boundary() const noexcept {
  return detail::element_body<E>(this->elastic_body()).boundary();
}

}}  // namespace palpate

#if !PALPATE_HEADER_ONLY
#include <palpate/model/shipped/shipped.hpp>
#endif
