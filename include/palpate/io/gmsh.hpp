// Gmsh meshes: read_mesh reads them like all others.
#pragma once

#include <palpate/io/read_mesh.hpp>

namespace palpate::inline PALPATE_ABI::io {

using GmshNumbering = MeshNumbering;

}  // namespace palpate::inline PALPATE_ABI::io
