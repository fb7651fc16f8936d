// Faces of every kind as touchable triangles.
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/detail/touchable.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include "catch.hpp"

using namespace palpate;

namespace {

template <Element E>
Mesh<E> block() {
  if constexpr (std::same_as<E, Tet4>)
    return box_tet4({3, 2, 1}, {3, 2, 1});
  else if constexpr (std::same_as<E, Tet10>)
    return box_tet10({3, 2, 1}, {3, 2, 1});
  else if constexpr (std::same_as<E, Hex8>)
    return box_hex8({3, 2, 1}, {3, 2, 1});
  else
    return box_hex20({3, 2, 1}, {3, 2, 1});
}

template <Element E>
detail::Touchable touched(const Mesh<E>& mesh, const std::string& group) {
  return detail::resolve_touchable(mesh_ref(mesh), extract_boundary<E>(mesh), Scene().touch(group));
}

ContactSurface surface_of(const detail::Touchable& touchable, const std::vector<Vector3>& positions) {
  std::vector<Vector3> of_vertices;
  for (NodeId node : touchable.nodes) of_vertices.push_back(positions[static_cast<std::size_t>(node)]);
  return {of_vertices, touchable.triangles};
}

}  // namespace

TEMPLATE_TEST_CASE("the touchable triangles are the surface, closed and outward", "[model][touch]", Tet4, Tet10, Hex8,
                   Hex20) {
  const Mesh<TestType> mesh = block<TestType>();
  const detail::Touchable all = touched(mesh, "surface");
  CHECK(all.nodes == nodes_of(extract_boundary<TestType>(mesh)));
  const ContactSurface surface = surface_of(all, mesh.positions);
  Vector3 sum = Vector3::Zero();
  double area = 0.0, volume = 0.0;
  for (const Triangle& t : surface.triangles()) {
    const Vector3 half =
        0.5 * (surface.position(t[1]) - surface.position(t[0])).cross(surface.position(t[2]) - surface.position(t[0]));
    sum += half;
    area += half.norm();
    volume += half.dot(surface.position(t[0])) / 3.0;
  }
  CHECK(sum.norm() <= 1e-13);
  CHECK_THAT(area, Catch::Matchers::WithinRel(22.0, 1e-13));
  CHECK_THAT(volume, Catch::Matchers::WithinRel(6.0, 1e-13));
  CHECK(surface.closest({1.4, 0.9, 0.9}).distance < 0.0);
  CHECK(surface.closest({1.4, 0.9, 1.1}).distance > 0.0);
  const detail::Touchable top = touched(mesh, "z1");
  CHECK(top.nodes == mesh.find_group("z1")->nodes);
  for (std::size_t t = 0; t < top.triangles.size(); ++t)
    CHECK(surface_of(top, mesh.positions).normal(static_cast<int>(t)) == Vector3(0, 0, 1));
}

TEMPLATE_TEST_CASE("contact weights are positive, sum to one, and carry force and moment", "[model][touch]", Tet4,
                   Tet10, Hex8, Hex20) {
  Mesh<TestType> mesh = block<TestType>();
  testing::Random random(37);
  for (Vector3& x : mesh.positions) x += random.vector<3>(-0.05, 0.05);  // curved faces
  const ContactSurface surface = surface_of(touched(mesh, "surface"), mesh.positions);
  const detail::ContactSamples samples(surface, 0.2);
  REQUIRE(samples.count() > surface.vertex_count());
  const Vector3 force(0.3, -0.2, 1.0);
  Matrix3 gradient;
  for (int i = 0; i < 3; ++i) gradient.col(i) = random.vector<3>(-1.0, 1.0);
  for (int s = 0; s < samples.count(); ++s) {
    const detail::ContactSample& sample = samples[s];
    double sum = 0.0, work = 0.0;
    Vector3 at = Vector3::Zero(), moved = Vector3::Zero(), moment = Vector3::Zero();
    for (std::size_t a = 0; a < 3; ++a) {
      const double w = sample.weights[a];
      const Vector3& x = surface.position(sample.vertices[a]);
      CHECK(w >= 0.0);  // vertex functions of Tri6 and Quad8 are negative over much of the face
      sum += w;
      at += w * x;
      moved += w * (gradient * x);
      moment += x.cross(w * force);
      work += (w * force).dot(gradient * x);
    }
    CHECK_THAT(sum, Catch::Matchers::WithinAbs(1.0, 1e-14));
    CHECK((moved - gradient * at).norm() <= 1e-13);                         // a linear field is reproduced exactly
    CHECK((moment - at.cross(force)).norm() <= 1e-13);                      // the force acts where the point is
    CHECK_THAT(work, Catch::Matchers::WithinAbs(force.dot(moved), 1e-13));  // and works as much as the point moves
  }
}
