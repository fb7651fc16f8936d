// What palpate::compiled holds of templates: set-up with the shipped elements and linear materials. Sources that use
// these do not compile them; for elements and materials of one's own the same templates are compiled where they are
// used.
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
#include <palpate/model/haptic_fe_model.tpp>

/// The model of one composition, made from a mesh of type GIVEN; PREFIX is `extern` to declare it, nothing to compile
/// it.
#define PALPATE_SHIPPED_MODEL(PREFIX, E, M, GIVEN, ...)                                                            \
  PREFIX template HapticFEModel<E, M, __VA_ARGS__>::HapticFEModel(const Mesh<GIVEN>&, const Scene&,                \
                                                                  const RegionMaterials<M>&, const SetupOptions&); \
  PREFIX template HapticFEModel<E, M, __VA_ARGS__>::HapticFEModel(const Mesh<GIVEN>&, const Scene&, const M&,      \
                                                                  const SetupOptions&);

/// One element and one material.
#define PALPATE_SHIPPED_MATERIAL(PREFIX, E, M, GIVEN)                                                                \
  PREFIX template std::vector<M> materials_by_region<M, Mesh<GIVEN>>(const Mesh<GIVEN>&, const RegionMaterials<M>&); \
  PALPATE_SHIPPED_MODEL(PREFIX, E, M, GIVEN, Condensed<SelectiveInverse>)

/// One element, made from a mesh of another type with the same nodes.
#define PALPATE_SHIPPED_MESH(PREFIX, E, GIVEN)                                                  \
  PREFIX template Admitted<E> admit<E, Mesh<GIVEN>>(const Mesh<GIVEN>&, const AdmissionPolicy&, \
                                                    const std::vector<std::string>&);           \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, LinearElastic, GIVEN)                                     \
  PALPATE_SHIPPED_MODEL(PREFIX, E, LinearElastic, GIVEN, Condensed<SelectiveInverseFloat>)      \
  PALPATE_SHIPPED_MODEL(PREFIX, E, LinearElastic, GIVEN, Condensed<DenseCholesky>)              \
  PALPATE_SHIPPED_MODEL(PREFIX, E, LinearElastic, GIVEN, Condensed<ConjugateGradient>)          \
  PALPATE_SHIPPED_MODEL(PREFIX, E, LinearElastic, GIVEN, SparseCholesky)                        \
  PALPATE_SHIPPED_MODEL(PREFIX, E, LinearElastic, GIVEN, ConjugateGradient)                     \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, TransverselyIsotropic, GIVEN)                             \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, Orthotropic, GIVEN)

/// One element.
#define PALPATE_SHIPPED_ELEMENT(PREFIX, E)                                                         \
  PREFIX template class ElementBody<E>;                                                            \
  PREFIX template class HapticFEModel<E, LinearElastic, Condensed<SelectiveInverse>>;              \
  PREFIX template class HapticFEModel<E, TransverselyIsotropic, Condensed<SelectiveInverse>>;      \
  PREFIX template class HapticFEModel<E, Orthotropic, Condensed<SelectiveInverse>>;                \
  PREFIX template class MatrixFreeStiffness<E>;                                                    \
  PREFIX template void report_admission<E>(const Admitted<E>&, SetupReport&);                      \
  PREFIX template BlockMatrix assemble_stiffness<E>(const Body<E>&, const SetupLimits&);           \
  PREFIX template Body<E> make_body<E, LinearElastic>(Mesh<E>, const std::vector<LinearElastic>&); \
  PREFIX template Body<E> make_body<E, Orthotropic>(Mesh<E>, const std::vector<Orthotropic>&);     \
  PREFIX template Body<E> make_body<E, TransverselyIsotropic>(Mesh<E>, const std::vector<TransverselyIsotropic>&);

#define PALPATE_SHIPPED_TET4(PREFIX) PALPATE_SHIPPED_ELEMENT(PREFIX, Tet4) PALPATE_SHIPPED_MESH(PREFIX, Tet4, Tet4)
#define PALPATE_SHIPPED_TET10(PREFIX) PALPATE_SHIPPED_ELEMENT(PREFIX, Tet10) PALPATE_SHIPPED_MESH(PREFIX, Tet10, Tet10)
#define PALPATE_SHIPPED_HEX8(PREFIX) PALPATE_SHIPPED_ELEMENT(PREFIX, Hex8) PALPATE_SHIPPED_MESH(PREFIX, Hex8, Hex8)
#define PALPATE_SHIPPED_HEX20(PREFIX) PALPATE_SHIPPED_ELEMENT(PREFIX, Hex20) PALPATE_SHIPPED_MESH(PREFIX, Hex20, Hex20)
#define PALPATE_SHIPPED_SMOOTHED_TET4(PREFIX)        \
  PALPATE_SHIPPED_ELEMENT(PREFIX, Smoothed<Tet4>)    \
  PALPATE_SHIPPED_MESH(PREFIX, Smoothed<Tet4>, Tet4) \
  PALPATE_SHIPPED_MESH(PREFIX, Smoothed<Tet4>, Smoothed<Tet4>)
#define PALPATE_SHIPPED_MEAN_DILATATION_HEX8(PREFIX)       \
  PALPATE_SHIPPED_ELEMENT(PREFIX, MeanDilatation<Hex8>)    \
  PALPATE_SHIPPED_MESH(PREFIX, MeanDilatation<Hex8>, Hex8) \
  PALPATE_SHIPPED_MESH(PREFIX, MeanDilatation<Hex8>, MeanDilatation<Hex8>)

#if !PALPATE_HEADER_ONLY
namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_TET4(extern)
PALPATE_SHIPPED_TET10(extern)
PALPATE_SHIPPED_HEX8(extern)
PALPATE_SHIPPED_HEX20(extern)
PALPATE_SHIPPED_SMOOTHED_TET4(extern)
PALPATE_SHIPPED_MEAN_DILATATION_HEX8(extern)

}}  // namespace palpate
#endif
