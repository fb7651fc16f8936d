// What palpate::compiled holds of templates: set-up with the shipped elements and linear materials. Sources that use
// these do not compile them; for elements and materials of one's own the same templates are compiled where they are used.
#pragma once

#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/mean_dilatation.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/material/transversely_isotropic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

/// Everything of one material with one element; PREFIX is `extern` to declare it and nothing to compile it.
#define PALPATE_SHIPPED_MATERIAL(PREFIX, E, M)                                                                  \
  PREFIX template std::vector<M> materials_by_region<M, Mesh<E>>(const Mesh<E>&, const RegionMaterials<M>&);    \
  PREFIX template Body<E> make_body<E, M>(Mesh<E>, const std::vector<M>&);                                      \
  PREFIX template class HapticFEModel<E, M, Condensed<SelectiveInverse>>;                                       \
  PREFIX template HapticFEModel<E, M, Condensed<SelectiveInverse>>::HapticFEModel(                              \
      const Mesh<E>&, const Scene&, const RegionMaterials<M>&, const SetupOptions&);                            \
  PREFIX template HapticFEModel<E, M, Condensed<SelectiveInverse>>::HapticFEModel(const Mesh<E>&, const Scene&, \
                                                                                  const M&, const SetupOptions&);

/// Everything of one element.
#define PALPATE_SHIPPED_ELEMENT(PREFIX, E)                                                                  \
  PREFIX template class ElementBody<E>;                                                                     \
  PREFIX template class MatrixFreeStiffness<E>;                                                             \
  PREFIX template Admitted<E> admit<E, Mesh<E>>(const Mesh<E>&, const AdmissionPolicy&,                     \
                                                const std::vector<std::string>&);                           \
  PREFIX template void report_admission<E>(const Admitted<E>&, SetupReport&);                               \
  PREFIX template BlockMatrix assemble_stiffness<E>(const Body<E>&, const SetupLimits&);                    \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, LinearElastic)                                                        \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, TransverselyIsotropic)                                                \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, Orthotropic)

#if !PALPATE_HEADER_ONLY
namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_ELEMENT(extern, Tet4)
PALPATE_SHIPPED_ELEMENT(extern, Tet10)
PALPATE_SHIPPED_ELEMENT(extern, Hex8)
PALPATE_SHIPPED_ELEMENT(extern, Hex20)
PALPATE_SHIPPED_ELEMENT(extern, Smoothed<Tet4>)
PALPATE_SHIPPED_ELEMENT(extern, MeanDilatation<Hex8>)

}}  // namespace palpate
#endif
