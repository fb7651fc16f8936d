// Include next to palpate.hpp for mesh files other than Gmsh's, and to write results and meshes. FEBio and VTU files
// need pugixml: io/xml/read_mesh.hpp.
#pragma once

#include <palpate/io/pvd.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/io/surface_files.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/io/write_msh.hpp>
