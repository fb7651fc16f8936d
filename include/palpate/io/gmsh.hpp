// Gmsh meshes: read_mesh reads them like all other formats.
#pragma once

#include <palpate/io/read_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

using GmshNumbering = MeshNumbering;

}}}  // namespace palpate::PALPATE_ABI::io
