// expect: refine_near divides linear tetrahedra
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/refine_near.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Refined = Tet4;
#else
using Refined = Hex8;
#endif

Mesh<Refined> finer(const Mesh<Refined>& mesh) {
  return refine_near(mesh, "front", {.edge = 1e-3});
}
