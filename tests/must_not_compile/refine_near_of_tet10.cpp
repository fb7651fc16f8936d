// expect: refine_near divides linear tetrahedra. Quadratic ones: refine the Mesh<Tet4>, then promote<Tet10>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/refine_near.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Refined = Tet4;
#else
using Refined = Tet10;
#endif

Mesh<Refined> finer(const Mesh<Refined>& mesh) {
  return refine_near(mesh, "front", {.edge = 1e-3}, {.most_nodes = 20000});
}
