// Uniform refinement of tetrahedra.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Cuts every tetrahedron into eight, each with an eighth of its volume. Nodes keep their ids, element e becomes 8 e
/// ... 8 e + 7; regions, fibres and groups are transferred as in `promote`. Neighbours conform: the choice of the
/// diagonal affects only the interior of an element. Throws as promote does, and count_too_large beyond 2^31 elements.
Mesh<Tet4> refine(const Mesh<Tet4>& coarse);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/refine.ipp>
#endif
