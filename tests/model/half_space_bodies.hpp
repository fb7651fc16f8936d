#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/detail/project_half_space.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>
#include <numeric>

/// Blocks whose top is touched, with the table of their half-space.
namespace test {

using namespace palpate;

template <Element E>
struct TouchedBlock {
  Body<E> body;
  std::vector<BoundaryFace> boundary;
  std::vector<NodeId> touched;
  std::vector<std::uint8_t> constrained;
  BlockMatrix stiffness;

  /// Fixed where `fixed(x)`, touched where `touches(x)` on the boundary.
  template <class Fixed, class Touches>
  TouchedBlock(Mesh<E> mesh, const LinearElastic& material, Fixed fixed, Touches touches)
      : body(make_body(std::move(mesh), material)), boundary(extract_boundary<E>(body.mesh)) {
    for (const NodeId n : nodes_of(boundary))
      if (touches(body.mesh.position(n))) touched.push_back(n);
    for (const Vector3& x : body.mesh.positions) constrained.push_back(fixed(x) ? 7 : 0);
    stiffness = assemble_stiffness<E>(body, {});
  }

  detail::ProjectedHalfSpace table(const SetupLimits& limits = {}) const {
    return detail::project_half_space<E>(body, boundary, touched, constrained, &stiffness, limits);
  }
};

/// A block of n x n x depth cells of unit length, its inner nodes and those of the top within it moved by up to
/// `jitter`.
template <Element E>
Mesh<E> jittered_block(int n, int depth, double jitter, BoxSplit split = BoxSplit::five_mirrored) {
  const Mesh<Tet4> plain = box_tet4(Vector3(n, n, depth), {n, n, depth}, split);
  Mesh<E> mesh{plain.positions, plain.elements, {}, {"body"}, plain.groups};
  testing::Random random(11);
  for (Vector3& x : mesh.positions) {
    Vector3 step = random.vector<3>(-jitter, jitter);
    const Vector3 size(n, n, depth);
    for (int i = 0; i < 3; ++i)
      if (x[i] < 1e-9 || x[i] > size[i] - 1e-9) step[i] = 0.0;
    x += step;
  }
  return mesh;
}

}  // namespace test
