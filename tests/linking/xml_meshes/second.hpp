// A mesh that crosses translation units, and what both must agree on.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

#include <string>

palpate::Mesh<palpate::Tet4> read_in_second(const std::string& path);
