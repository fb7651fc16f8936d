// expect: Mine::shape(
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

using namespace palpate;

struct Mine : Tet4 {
#ifdef PALPATE_GOOD_TWIN
  static Eigen::Vector4d shape(const Vector3&) noexcept;
#else
  static Eigen::Vector4d shape(const Vector3&);
#endif
};

Mesh<Mine> mesh;
