#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/mesh/where.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <random>

#include "cell.hpp"

namespace force_error {

namespace {

TestBody organ(const std::string& name, double lesion) {
  TestBody body{name, "ligament", "front", io::read_mesh<Tet4>(PALPATE_BENCH_DATA "/organ.msh")};
  body.stiff_region = lesion;
  return body;
}

TestBody block(const std::string& name, const std::string& fixed, const Vector3& size,
               const std::array<int, 3>& cells) {
  TestBody body{name, fixed, "z1", box_tet4(size, cells)};
  body.hexahedra = [size](double edge) {
    std::array<int, 3> n{};
    for (std::size_t i = 0; i < 3; ++i)
      n[i] = std::max(1, static_cast<int>(std::lround(size[static_cast<Eigen::Index>(i)] / edge)));
    return box_hex8(size, n);
  };
  return body;
}

TestBody round_body() {
  const double radius = 0.04;
  const Vector3 up = Vector3::UnitZ();
  return {"round body", where::below(-0.6 * radius * up), where::above(-0.1 * radius * up), sphere_tet4(radius, 7)};
}

/// The upper edge of a block along y, at x = 0. Everything above a plane in the middle can be touched.
TestBody edge_of_block() {
  const Vector3 size(0.1, 0.1, 0.08);
  TestBody body{"edge", "z0", where::above({0.0, 0.0, 0.03}), box_tet4(size, {10, 10, 8})};
  body.edge_a = {0.0, 0.02, size[2]};
  body.edge_b = {0.0, 0.08, size[2]};
  return body;
}

}  // namespace

std::vector<TestBody> test_bodies() {
  return {organ("organ", 1.0),
          organ("inclusion", 10.0),
          block("block", "z0", {0.1, 0.1, 0.08}, {10, 10, 8}),
          block("thin lobe", "x0", {0.1, 0.06, 0.015}, {20, 12, 3}),
          round_body(),
          edge_of_block()};
}

/// Places a quarter to a whole radius from the edge, on its upper side.
static std::vector<TestPlace> places_beside_edge(const TestBody& body, double radius, unsigned seed,
                                                 std::size_t count) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<TestPlace> places;
  for (std::size_t i = 0; i < count; ++i) {
    const Vector3 along = body.edge_a + unit(random) * (body.edge_b - body.edge_a);
    const double beside = radius * (0.25 + 0.75 * (static_cast<double>(i) + unit(random)) / static_cast<double>(count));
    places.push_back({along + beside * Vector3::UnitX(), Vector3::UnitZ()});
  }
  return places;
}

/// Of the faces outside, those on the opposite side of a thin body do not count.
std::vector<TestPlace> places_on(const TestBody& body, double radius, double margin, unsigned seed, std::size_t count) {
  if (body.edge_a != body.edge_b) return places_beside_edge(body, radius, seed, count);
  const Mesh<Tet4>& mesh = body.tetrahedra;
  const auto boundary = extract_boundary<Tet4>(mesh);
  const auto faces = detail::resolve_faces(mesh, boundary, body.touched);
  const auto normal = [&](const BoundaryFace& f) -> Vector3 {
    const Vector3 a = mesh.position(f.nodes[0]);
    return (mesh.position(f.nodes[1]) - a).cross(mesh.position(f.nodes[2]) - a).normalized();
  };
  Vector3 mean = Vector3::Zero();
  for (const BoundaryFace& f : faces) mean += normal(f) / static_cast<double>(faces.size());
  std::vector<Vector3> outside;
  for (const BoundaryFace& f : boundary)
    if ((body.name == "round body" || normal(f).dot(mean) > -0.5) &&
        std::none_of(faces.begin(), faces.end(), [&](const BoundaryFace& g) { return g.key() == f.key(); }))
      outside.push_back((mesh.position(f.nodes[0]) + mesh.position(f.nodes[1]) + mesh.position(f.nodes[2])) / 3.0);
  std::mt19937 random(seed);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  std::vector<TestPlace> places;
  for (int tries = 0; tries < 1000 && places.size() < count; ++tries) {
    const BoundaryFace& f = faces[random() % faces.size()];
    const Vector3 a = mesh.position(f.nodes[0]), b = mesh.position(f.nodes[1]), c = mesh.position(f.nodes[2]);
    double s = unit(random), t = unit(random);
    if (s + t > 1.0) {
      s = 1.0 - s;
      t = 1.0 - t;
    }
    const Vector3 point = a + s * (b - a) + t * (c - a);
    const bool near_rim =
        std::any_of(outside.begin(), outside.end(), [&](const Vector3& p) { return (p - point).norm() < margin; });
    if (!near_rim) places.push_back({point, (b - a).cross(c - a).normalized()});
  }
  return places;
}

double mean_facet(const TestBody& body) {
  const Mesh<Tet4>& mesh = body.tetrahedra;
  const auto faces = detail::resolve_faces(mesh, extract_boundary<Tet4>(mesh), body.touched);
  double sum = 0.0;
  for (const BoundaryFace& f : faces) {
    const Vector3 a = mesh.position(f.nodes[0]), b = mesh.position(f.nodes[1]), c = mesh.position(f.nodes[2]);
    sum += std::sqrt((b - a).cross(c - a).norm());
  }
  return sum / static_cast<double>(faces.size());
}

}  // namespace force_error
