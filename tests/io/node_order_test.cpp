// Node orders: the tables are permutations, and files of other programs confirm them: every mid-edge node must be at
// the position that the element defines.
#include "samples.hpp"
#include "element/user_elements.hpp"

#include <palpate/io/detail/gmsh_types.hpp>
#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/text_reader.hpp>
#include <palpate/io/detail/vtk_cells.hpp>
#include <palpate/io/write_msh.hpp>

#include <algorithm>
#include <numeric>

using namespace palpate;

namespace {

template <int R, int C>
using Table = Eigen::Matrix<double, R, C>;

/// A hexahedron of 20 nodes in an order that no file format uses: corners in binary order, then the middles of the
/// edges along z, y and x. Only the positions of its nodes matter here; its functions are all zero.
struct ZeroQuad8 {
  static constexpr int nodes = 8;
  using Quadrature = user::TensorRule<2, 2>;
  static Table<8, 1> shape(const Vector2&) noexcept { return Table<8, 1>::Zero(); }
  static Table<8, 2> gradient(const Vector2&) noexcept { return Table<8, 2>::Zero(); }
  static Table<8, 2> reference_nodes() noexcept { return Table<8, 2>::Zero(); }
};

struct ReorderedHex20 {
  static constexpr int nodes = 20, order = 2;
  static constexpr double reference_volume = 8.0;
  static constexpr std::array<std::array<int, 8>, 6> faces{};
  using Face = ZeroQuad8;
  using Quadrature = user::TensorRule<2, 3>;
  using MassQuadrature = user::TensorRule<2, 3>;
  static Table<20, 1> shape(const Vector3&) noexcept { return Table<20, 1>::Zero(); }
  static Table<20, 3> gradient(const Vector3&) noexcept { return Table<20, 3>::Zero(); }
  static Table<20, 3> reference_nodes() noexcept {
    Table<20, 3> x;
    int row = 0;
    for (int k = 0; k < 8; ++k) x.row(row++) << (k & 1) * 2 - 1, (k & 2) - 1, (k & 4) / 2 - 1;
    for (int axis = 2; axis >= 0; --axis)
      for (int k = 0; k < 4; ++k, ++row) {
        x(row, axis) = 0;
        x(row, (axis + 1) % 3) = (k & 1) * 2 - 1;
        x(row, (axis + 2) % 3) = (k & 2) - 1;
      }
    return x;
  }
};

/// A hexahedron or tetrahedron with reversed ends: the orders must still match.
struct LastFirst : user::Hex8 {
  static Table<8, 3> reference_nodes() noexcept { return user::Hex8::reference_nodes().colwise().reverse(); }
};

bool is_permutation_of(std::span<const int> order, std::size_t count) {
  std::vector<int> sorted(order.begin(), order.end()), expected(count);
  std::ranges::sort(sorted);
  std::iota(expected.begin(), expected.end(), 0);
  return sorted == expected;
}

/// The largest distance of a node from its expected position between the corners, for straight edges.
template <class E>
double mid_edge_error(const Mesh<E>& mesh) {
  double worst = 0.0;
  const auto xi = io::nodes_on_unit_domain<E>();
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const auto x = element_nodes<E>(mesh, e);
    // The affine map by the nodes at 0, e1, e2, e3 of the unit domain; exact for tetrahedra and parallelepipeds.
    std::array<int, 4> at{};
    for (int c = 0; c < 4; ++c)
      for (int a = 0; a < E::nodes; ++a)
        if ((xi.row(a).transpose() - (c == 0 ? Vector3(0, 0, 0) : Vector3(Vector3::Unit(c - 1)))).norm() < 1e-9)
          at[static_cast<std::size_t>(c)] = a;
    for (int a = 0; a < E::nodes; ++a) {
      Vector3 y = x.row(at[0]).transpose();
      for (int c = 0; c < 3; ++c)
        y += xi(a, c) * (x.row(at[static_cast<std::size_t>(c) + 1]) - x.row(at[0])).transpose();
      worst = std::max(worst, (y - x.row(a).transpose()).norm());
    }
  }
  return worst;
}

/// Written by Gmsh 4.8.4 with -order 2 and Mesh.SecondOrderIncomplete = 1: a unit cube.
const std::string cube_nodes = R"(1 0 0 0
2 1 0 0
3 0 1 0
4 1 1 0
5 0 0 1
6 1 0 1
7 1 1 1
8 0 1 1
9 0.5 0 0
10 0.5 1 0
11 0 0.5 0
12 1 0.5 0
13 0.5 0 1
14 1 0.5 1
15 0.5 1 1
16 0 0.5 1
17 0 0 0.5
18 1 0 0.5
19 1 1 0.5
20 0 1 0.5
)";
const std::string gmsh_hex20 =
    "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n20\n" + cube_nodes +
    "$EndNodes\n$Elements\n1\n1 17 2 1 1 1 2 4 3 5 6 7 8 9 11 17 12 18 10 19 20 13 16 14 15\n"
    "$EndElements\n";

/// The same cube as Gmsh exports it to VTK.
std::string vtk_hex20() {
  std::string points;
  io::TextReader in(cube_nodes, "cube");
  while (in.next_line()) {
    in.token();
    points += std::string(in.rest()) + '\n';
  }
  return "# vtk DataFile Version 2.0\nhex\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 20 double\n" + points +
         "CELLS 1 21\n20 0 1 3 2 4 5 6 7 8 11 9 10 12 13 14 15 16 17 18 19\nCELL_TYPES 1\n25\n";
}

/// The first two tetrahedra that TetGen 1.5 -o2 makes of a cube.
const std::string tetgen_tet10 =
    "19 3 0 0\n0 0 0 0\n1 1 0 0\n2 1 1 0\n3 0 1 0\n4 0 0 1\n5 1 0 1\n6 1 1 1\n7 0 1 1\n8 0.5 1 0.5\n9 0.5 0.5 0\n"
    "10 0 0.5 0\n11 0 1 0.5\n12 0.5 1 0\n13 0 0.5 0.5\n14 0.5 0.5 1\n15 0.5 0.5 0.5\n16 0 0.5 1\n17 0.5 1 1\n"
    "18 0 0 0.5\n\x1f"
    "2 10 1\n0 0 3 7 2 8 9 10 11 12 13 3\n1 0 7 4 6 14 15 13 16 17 18 3\n\x1f"
    "1 1\n0 2 0 3 9 10 12 7\n";

template <class E>
Mesh<E> build(const std::string& format, const std::string& text) {
  return io::build_mesh<E>(test::parse_as(format, text), 1.0, nullptr);
}

}  // namespace

TEST_CASE("Every table of node orders is a permutation", "[io]") {
  const auto check = [](io::NodeOrder order, std::size_t count) {
    CHECK(is_permutation_of(std::vector<int>(order.begin(), order.end()), count));
  };
  check(io::gmsh_tetrahedron10, 10);
  check(io::gmsh_hexahedron20, 20);
  check(io::tetgen_tetrahedron10, 10);
  check(io::voxel_hexahedron8, 8);
  check(io::pixel_quadrangle4, 4);
  for (const auto& type : io::gmsh::types)
    CHECK((type.order.empty() || static_cast<int>(type.order.size()) == io::facts(type.shape).nodes));
  for (const auto& type : io::vtk::cell_types)
    CHECK((type.order.empty() || static_cast<int>(type.order.size()) == io::facts(type.shape).nodes));
}

TEMPLATE_TEST_CASE("The node order of an element maps to VTK's and back", "[io]", Tet4, user::Tet10, user::Hex8,
                   LastFirst, ReorderedHex20) {
  const auto from = io::element_order<TestType>();
  const auto back = io::vtk_order<TestType>();
  CHECK(is_permutation_of(from, from.size()));
  for (std::size_t a = 0; a < from.size(); ++a) CHECK(back[static_cast<std::size_t>(from[a])] == static_cast<int>(a));
}

TEST_CASE("Elements in VTK's own order need no permutation", "[io]") {
  std::array<int, 10> ten{};
  std::iota(ten.begin(), ten.end(), 0);
  CHECK(io::element_order<user::Tet10>() == ten);
  std::array<int, 8> eight{};
  std::iota(eight.begin(), eight.end(), 0);
  CHECK(io::element_order<user::Hex8>() == eight);
  std::ranges::reverse(eight);
  CHECK(io::element_order<LastFirst>() == eight);
}

TEST_CASE("Mid-edge nodes of real files lie on their edges", "[io]") {
  CHECK(mid_edge_error(build<ReorderedHex20>("msh2", gmsh_hex20)) < 1e-12);
  CHECK(mid_edge_error(build<ReorderedHex20>("vtk2", vtk_hex20())) < 1e-12);
  CHECK(build<ReorderedHex20>("msh2", gmsh_hex20).elements == build<ReorderedHex20>("vtk2", vtk_hex20()).elements);
  const auto tet10 = build<user::Tet10>("tetgen", tetgen_tet10);
  CHECK(tet10.element_count() == 2);
  CHECK(tet10.find_group("surface 7")->faces == std::vector<std::vector<NodeId>>{{2, 0, 3, 9, 10, 12}});
  CHECK(mid_edge_error(tet10) < 1e-12);
  // The check can fail: two swapped nodes are half an edge away.
  auto wrong = tet10;
  std::swap(wrong.elements[0][4], wrong.elements[0][9]);
  CHECK(mid_edge_error(wrong) > 0.4);
}

TEST_CASE("A file written for Gmsh reads back for every element type", "[io]") {
  const auto there_and_back = [](const auto& mesh, auto element) {
    using E = decltype(element);
    const std::string text = io::msh_text(mesh);
    const auto back = build<E>("msh2", text);
    CHECK(back.elements == mesh.elements);
    CHECK(back.positions == mesh.positions);
    return text;
  };
  const auto tet10 = build<user::Tet10>("tetgen", tetgen_tet10);
  // Gmsh's last two edges are those of nodes 2 3 and 1 3.
  CHECK_THAT(there_and_back(tet10, user::Tet10{}), test::contains(" 11 2 1 1 1 4 8 3 11 12 14 10 9 13"));
  there_and_back(build<ReorderedHex20>("msh2", gmsh_hex20), ReorderedHex20{});
}

TEST_CASE("VTK's voxel is a hexahedron with two pairs of corners swapped", "[io]") {
  const std::string text =
      "# vtk DataFile Version 2.0\n\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 8 double\n0 0 0 1 0 0 0 1 0 1 1 0\n"
      "0 0 1 1 0 1 0 1 1 1 1 1\nCELLS 1 9\n8 0 1 2 3 4 5 6 7\nCELL_TYPES 1\n11\n";
  CHECK(build<user::Hex8>("vtk2", text).elements[0] == std::array<NodeId, 8>{0, 1, 3, 2, 4, 5, 7, 6});
  CHECK(mid_edge_error(build<user::Hex8>("vtk2", text)) < 1e-12);
}

TEST_CASE("An element that is neither corner nor mid-edge anywhere is refused", "[io]") {
  struct Odd : user::Hex8 {
    static Table<8, 3> reference_nodes() noexcept {
      Table<8, 3> x = user::Hex8::reference_nodes();
      x(6, 2) = 0.3;
      return x;
    }
  };
  CHECK_THROWS_AS(io::element_order<Odd>(), SetupError);
}
