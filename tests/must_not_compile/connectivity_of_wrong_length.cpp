// expect: , 10>
// An element of ten nodes is appended to a mesh of four-node elements.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Ids = std::array<int, 4>;
#else
using Ids = std::array<int, 10>;
#endif

void add(Mesh<Tet4>& mesh, const Ids& ids) {
  mesh.elements.push_back(ids);
}
