// The node and element sections of Gmsh's formats 1 and 2 (MSH 1, MSH 2.0 to 2.2).
#pragma once

#include <palpate/io/detail/gmsh_state.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh::msh2 {

/// $Nodes (in MSH 1 $NOD): the count, then the nodes. $ParametricNodes adds the entity of each node and its parameters,
/// which are skipped.
void read_nodes(TextReader& in, State& state, bool is_parametric);

/// $Elements (in MSH 1 $ELM). An element in several physical groups is listed several times.
void read_elements(TextReader& in, State& state);

}}}  // namespace palpate::PALPATE_ABI::io::gmsh::msh2

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/gmsh_msh2.ipp>
#endif
