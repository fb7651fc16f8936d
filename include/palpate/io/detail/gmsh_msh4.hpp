// The entity, node and element sections of Gmsh's format 4.1.
#pragma once

#include <palpate/io/detail/gmsh_state.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh::msh4 {

/// $Entities: numbers of points, curves, surfaces and volumes, then the entities.
void read_entities(TextReader& in, State& state);

/// $Nodes.
void read_nodes(TextReader& in, State& state);

/// $Elements.
void read_elements(TextReader& in, State& state);

}}}  // namespace palpate::PALPATE_ABI::io::gmsh::msh4

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/gmsh_msh4.ipp>
#endif
