// expect: deleted
// The positions outlive the mesh view, the connectivity does not.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh_arrays.hpp>

using namespace palpate;

Index count(const std::vector<float>& positions, std::vector<long>& ids) {
#ifdef PALPATE_GOOD_TWIN
  const MeshArrays<Tet4, float, long> mesh(positions, ids);
#else
  const MeshArrays<Tet4, float, long> mesh(positions, std::vector<long>(ids));
#endif
  return mesh.node_count();
}
