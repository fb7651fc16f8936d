// expect: Element
// The gradient is 3 x 4 instead of 4 x 3.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

using namespace palpate;

struct Mine : Tet4 {
#ifdef PALPATE_GOOD_TWIN
  static Eigen::Matrix<double, 4, 3> gradient(const Vector3&) noexcept;
#else
  static Eigen::Matrix<double, 3, 4> gradient(const Vector3&) noexcept;
#endif
};

Mesh<Mine> mesh;
