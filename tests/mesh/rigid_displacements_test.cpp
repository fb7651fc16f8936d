// Rigid motions as displacements.
#include <palpate/mesh/detail/rigid_modes.hpp>
#include <palpate/mesh/generators.hpp>

#include <Eigen/LU>

#include "catch.hpp"

#include <cmath>

using namespace palpate;

namespace {

std::vector<std::uint8_t> free_nodes(const Mesh<Tet4>& mesh) {
  return std::vector<std::uint8_t>(mesh.positions.size(), 0);
}

}  // namespace

TEST_CASE("a free body has six rigid displacements, all without strain", "[mesh][rigid]") {
  const Mesh<Tet4> mesh = box_tet4({3, 2, 1}, {2, 2, 1});
  const MatrixX modes = detail::rigid_displacements(mesh, free_nodes(mesh));
  REQUIRE(modes.cols() == 6);
  CHECK(Eigen::FullPivLU<MatrixX>(modes).rank() == 6);
  for (Index k = 0; k < 6; ++k)
    for (Index i = 0; i < mesh.node_count(); ++i)
      for (Index j = 0; j < i; ++j) {  // distances stay
        const Vector3 x = mesh.position(i) - mesh.position(j);
        const Vector3 u = modes.col(k).segment<3>(3 * i) - modes.col(k).segment<3>(3 * j);
        CHECK(std::abs(u.dot(x)) <= 1e-13);
      }
}

TEST_CASE("rigid displacements satisfy the constraints", "[mesh][rigid]") {
  const Mesh<Tet4> mesh = box_tet4({3, 2, 1}, {2, 2, 1});
  auto constrained = free_nodes(mesh);
  for (NodeId i : mesh.find_group("z0")->nodes)
    constrained[static_cast<std::size_t>(i)] = 4;  // z constrained: three are left
  MatrixX modes = detail::rigid_displacements(mesh, constrained);
  REQUIRE(modes.cols() == 3);
  for (NodeId i : mesh.find_group("z0")->nodes) CHECK(modes.row(3 * i + 2).cwiseAbs().maxCoeff() <= 1e-14);
  for (NodeId i : mesh.find_group("z0")->nodes) constrained[static_cast<std::size_t>(i)] = 7;
  CHECK(detail::rigid_displacements(mesh, constrained).cols() == 0);
  constrained.pop_back();
  CHECK_THROWS_AS(detail::rigid_displacements(mesh, constrained), SetupError);
}
