#include "second.hpp"

#include <palpate/io/xml/read_mesh.hpp>

palpate::Mesh<palpate::Tet4> read_in_second(const std::string& path) {
  return palpate::io::xml::read_mesh<palpate::Tet4>(path);
}
