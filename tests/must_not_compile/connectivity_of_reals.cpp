// expect: integral
// Node ids read as real numbers from a file.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh_arrays.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Id = unsigned short;
#else
using Id = double;
#endif

Index count(const std::vector<double>& positions, const std::vector<Id>& ids) {
  return MeshArrays<Tet4, double, Id>(positions, ids).node_count();
}
