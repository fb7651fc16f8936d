// How thick a body is under a press, and the mesh that is fine enough for its bending.
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/static/detail/thin_body.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>

using namespace palpate;

namespace {

double longest_edge_of(const Mesh<Tet4>& mesh) {
  double longest = 0.0;
  for (const auto& element : mesh.elements)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        longest = std::max(longest, (mesh.position(element[a]) - mesh.position(element[b])).norm());
  return longest;
}

}  // namespace

TEST_CASE("the thickness is the distance to the opposite side along the press", "[force_error]") {
  const Mesh<Tet4> box = box_tet4(Vector3(0.06, 0.04, 0.01), {6, 4, 1});
  const auto boundary = extract_boundary<Tet4>(box);
  const Vector3 up(0.0, 0.0, 1.0), top(0.0213, 0.0171, 0.01);
  CHECK(detail::thickness_under({top, up}, box, boundary) == Catch::Approx(0.01));
  CHECK(detail::thickness_under({{0.02, 0.02, 0.01}, up}, box, boundary) ==
        Catch::Approx(0.01));  // over a vertex: edges below
  CHECK(detail::thickness_under({{0.06, 0.02, 0.005}, {1.0, 0.0, 0.0}}, box, boundary) == Catch::Approx(0.06));
  const Vector3 oblique = Vector3(0.6, 0.0, 0.8);
  CHECK(detail::thickness_under({top, oblique}, box, boundary) == Catch::Approx(0.01 / 0.8));
  CHECK(std::isinf(detail::thickness_under({{0.1, 0.02, 0.01}, up}, box, boundary)));  // beside the body
}

TEST_CASE("a thin mesh gets edges of a third of the thickness, a thick one stays", "[force_error]") {
  Mesh<Tet4> thin = box_tet4(Vector3(0.06, 0.04, 0.01), {6, 4, 1}), thick = thin;
  CHECK(detail::refine_through(thin, 0.01));
  CHECK(longest_edge_of(thin) <= 0.01 / 3.0 * (1.0 + 1e-12));
  const Index nodes = thick.node_count();
  CHECK(detail::refine_through(thick, 0.06));
  CHECK(thick.node_count() == nodes);
  CHECK(detail::refine_through(thick, infinity));
  CHECK(thick.node_count() == nodes);
}

TEST_CASE("a sheet that is too large stays as it is, and that is known", "[force_error]") {
  Mesh<Tet4> sheet = box_tet4(Vector3(0.5, 0.5, 0.005), {20, 20, 1});
  const Index nodes = sheet.node_count();
  CHECK_FALSE(detail::refine_through(sheet, 0.005));
  CHECK(sheet.node_count() == nodes);
}
