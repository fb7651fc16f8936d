// The template instantiations in palpate::compiled: models of the shipped elements, linear materials and solvers.
#pragma once

#include <palpate/element/hex20.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/model/haptic_fe_model.tpp>

/// The tissue of element E and material M, constructed from a Mesh<GIVEN>. The last argument is the solver. PREFIX is
/// `extern` to declare the instantiation, and empty to compile it.
#define PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, M, GIVEN, ...)    \
  PREFIX template StaticTissue<E, M, __VA_ARGS__>::StaticTissue( \
      const Mesh<GIVEN>&, const Scene&, const RegionMaterials<M>&, const SetupOptions&, const NoParameters&);

#define PALPATE_SHIPPED_MATERIAL(PREFIX, E, M) PREFIX template Body<E> make_body<E, M>(Mesh<E>, const std::vector<M>&);

#define PALPATE_SHIPPED_MATERIAL_ON(PREFIX, E, M, GIVEN)                                                       \
  PREFIX template detail::AdmittedBody detail::admit_body<E, M, Mesh<GIVEN>>(                                  \
      const Mesh<GIVEN>&, const Scene&, const RegionMaterials<M>&, const AdmissionPolicy&, const SetupLimits&, \
      SetupReport&);                                                                                           \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, M, GIVEN, Condensed<SelectiveInverse>)

/// All that is shipped for element E.
#define PALPATE_SHIPPED_ELEMENT(PREFIX, E)                                                              \
  PREFIX template class detail::ElementBody<E>;                                                         \
  PREFIX template const Mesh<E>& detail::mesh_of<E>(const ElasticBody&) noexcept;                       \
  PREFIX template const Body<E>& detail::body_of<E>(const ElasticBody&) noexcept;                       \
  PREFIX template const std::vector<BoundaryFace>& detail::boundary_of<E>(const ElasticBody&) noexcept; \
  PREFIX template class detail::MatrixFreeStiffness<E>;                                                 \
  PREFIX template void detail::report_admission<E>(const Admitted<E>&, SetupReport&);                   \
  PREFIX template BlockMatrix assemble_stiffness<E>(const Body<E>&, const SetupLimits&);                \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, LinearElastic)                                                    \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, TransverselyIsotropic)                                            \
  PALPATE_SHIPPED_MATERIAL(PREFIX, E, Orthotropic)

/// All that is shipped for element E on a mesh of GIVEN, an element with the same nodes.
#define PALPATE_SHIPPED_MESH(PREFIX, E, GIVEN)                                                              \
  PREFIX template Admitted<E> admit<E, Mesh<GIVEN>>(const Mesh<GIVEN>&, const AdmissionPolicy&,             \
                                                    const std::vector<std::string>&);                       \
  PALPATE_SHIPPED_MATERIAL_ON(PREFIX, E, LinearElastic, GIVEN)                                              \
  PALPATE_SHIPPED_MATERIAL_ON(PREFIX, E, TransverselyIsotropic, GIVEN)                                      \
  PALPATE_SHIPPED_MATERIAL_ON(PREFIX, E, Orthotropic, GIVEN)                                                \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, Condensed<SelectiveInverseFloat>)            \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, Condensed<DenseCholesky>)                    \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, Condensed<ConjugateGradient>)                \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, SparseCholesky)                              \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, ConjugateGradient)                           \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, WithAssembly<ConjugateGradient, MatrixFree>) \
  PALPATE_SHIPPED_CONSTRUCTOR(PREFIX, E, LinearElastic, GIVEN, SelectiveInverse)

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
