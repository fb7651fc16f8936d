// expect: Element
#include <palpate/element/tet4.hpp>
#include <palpate/testing/element_laws.hpp>

using namespace palpate;

struct Mine : Tet4 {
#ifndef PALPATE_GOOD_TWIN
  using MassQuadrature = TriangleRule<2>;
#endif
};

bool lawful() {
  return testing::element_laws<Mine>().empty();
}
