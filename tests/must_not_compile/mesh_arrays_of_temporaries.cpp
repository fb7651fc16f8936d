// expect: deleted
// A view of arrays that are destroyed at the end of the statement.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh_arrays.hpp>

using namespace palpate;

std::vector<double> positions();
std::vector<int> connectivity();

Index count() {
#ifdef PALPATE_GOOD_TWIN
  const std::vector<double> x = positions();
  const std::vector<int> ids = connectivity();
  const MeshArrays<Tet4, double, int> mesh(x, ids);
#else
  const MeshArrays<Tet4, double, int> mesh(positions(), connectivity());
#endif
  return mesh.node_count();
}
