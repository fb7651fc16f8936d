// Whether a point is in tissue beside a closed slit, and where the slit ends.
#include <palpate/contact/detail/blade_inside.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

using namespace palpate;

namespace {

/// Two blocks of 20 x 20 x 5 mm with facets of 5 mm, whose walls at x = 0 are `gap` apart, moved by a rigid motion.
ContactSurface cut_plate(double gap, const Matrix3& rotation, const Vector3& shift) {
  std::vector<Vector3> positions;
  std::vector<Triangle> triangles;
  for (const double side : {-1.0, 1.0}) {
    const double low = side < 0.0 ? -0.02 - 0.5 * gap : 0.5 * gap;
    const auto mesh = box_tet4(Vector3(0.02, 0.02, 0.005), {4, 4, 1}, BoxSplit::six, Vector3(low, -0.01, 0.0));
    const auto first = static_cast<int>(positions.size());
    for (const Vector3& x : mesh.positions) positions.push_back(rotation * x + shift);
    for (const BoundaryFace& f : extract_boundary<Tet4>(mesh))
      triangles.push_back({f.nodes[0] + first, f.nodes[1] + first, f.nodes[2] + first});
  }
  return {std::move(positions), std::move(triangles)};
}

}  // namespace

TEST_CASE("the tissue beside a closed slit ends where the slit ends", "[contact][blade]") {
  testing::Random random(3);
  constexpr double reach = 1e-3;
  int wrong_inside = 0, wrong_outside = 0;
  for (int k = 0; k < 40; ++k) {
    const Matrix3 rotation = k == 0 ? Matrix3(Matrix3::Identity()) : testing::random_rotation(random);
    const Vector3 shift = random.vector<3>(-0.1, 0.1);
    // Closed, and pressed together by a fifth of a millimetre.
    for (const double gap : {0.0, -2e-4}) {
      const ContactSurface surface = cut_plate(gap, rotation, shift);
      const auto is_inside = [&](double x, double y, double z) {
        return is_in_tissue(surface, rotation * Vector3(x, y, z) + shift, reach);
      };
      for (int i = 0; i < 50; ++i) {
        const double y = random.uniform(-9e-3, 9e-3), off = i % 5 == 0 ? 0.0 : random.uniform(-5e-5, 5e-5);
        wrong_inside += !is_inside(off, y, random.uniform(5e-4, 4.5e-3));
        const double beyond = random.uniform(1e-5, 8e-4);
        wrong_outside += is_inside(off, y, -beyond) || is_inside(off, y, 0.005 + beyond);
      }
    }
    const ContactSurface open = cut_plate(4e-4, rotation, shift);
    for (int i = 0; i < 50; ++i)
      wrong_outside += is_in_tissue(open,
                                    rotation * Vector3(random.uniform(-1.9e-4, 1.9e-4), random.uniform(-9e-3, 9e-3),
                                                       random.uniform(5e-4, 4.5e-3)) +
                                        shift,
                                    reach);
  }
  CHECK(wrong_inside == 0);
  CHECK(wrong_outside == 0);
}
