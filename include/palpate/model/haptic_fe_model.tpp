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
template <MeshOf<E> Given>
StaticTissue<E, M, Solver>::StaticTissue(const Given& mesh, const Scene& scene, const RegionMaterials<M>& materials,
                                         const SetupOptions& options, const Parameters&)
    : detail::StaticBase<M, Solver>::Type(options) {
  this->set_up(
      scene, detail::admit_body<E>(mesh, scene, materials, options.admission, this->limits(), this->setup_report()),
      detail::make_stiffness<E, typename SolverTraits<Solver>::Assembly>, detail::solver_recipe<Solver>(), options);
}

}}  // namespace palpate

#if !PALPATE_HEADER_ONLY
#include <palpate/model/shipped/shipped.hpp>
#endif
