// Uniform refinement of tetrahedra.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Every tetrahedron cut into eight of an eighth of its volume. Nodes keep their ids, element e becomes 8 e ... 8 e +
/// 7; regions, fibres and groups come along as in `promote`. Neighbours conform: only the interior of an element
/// depends on which diagonal was cut. Throws as promote does, and count_too_large beyond 2^31 elements.
Mesh<Tet4> refine(const Mesh<Tet4>& coarse);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/refine.ipp>
#endif
