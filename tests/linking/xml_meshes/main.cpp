// Both sources include the readers with pugixml and zlib: the program must link, and both must read the same meshes.
#include "second.hpp"

#include <palpate/io/xml/read_mesh.hpp>

#include <cstdio>

int main(int argc, char** argv) {
  for (int i = 1; i < argc; ++i) {
    const auto here = palpate::io::xml::read_mesh<palpate::Tet4>(argv[i]), there = read_in_second(argv[i]);
    std::printf("%s: %lld nodes, %lld elements\n", argv[i], static_cast<long long>(here.node_count()),
                static_cast<long long>(here.element_count()));
    if (here.node_count() != 5 || here.element_count() != 2 || here.positions != there.positions ||
        here.elements != there.elements)
      return 1;
  }
  try {  // an error of one source is caught in the other
    read_in_second("no/such.vtu");
  } catch (const palpate::SetupError& error) {
    return argc == 3 && error.kind() == palpate::SetupErrorKind::bad_file ? 0 : 2;
  }
  return 3;
}
