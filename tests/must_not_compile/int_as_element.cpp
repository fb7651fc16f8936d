// expect: Element
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

#ifdef PALPATE_GOOD_TWIN
palpate::Mesh<palpate::Tet4> mesh;
#else
palpate::Mesh<int> mesh;
#endif
