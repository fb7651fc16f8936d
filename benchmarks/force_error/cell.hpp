// One cell of the table: a body, a Poisson ratio, a radius; the truth and what models on the mesh as given say.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>

#include <string>
#include <vector>

namespace force_error {

using namespace palpate;

/// A body that is fixed and touched at groups of its mesh. Blocks have hexahedra too.
struct TestBody {
  std::string name, fixed, touched;
  Mesh<Tet4> tetrahedra;
  Mesh<Hex8> hexahedra;
  double stiff_region = 1.0;  ///< modulus of the organ's lesion relative to the rest
};

/// A place where the sphere is pressed: a point of the surface and the outward normal.
struct TestPlace {
  Vector3 point, outward;
};

/// What is varied.
struct Case {
  const TestBody& body;
  double poisson_ratio = 0.0;
  double radius = 0.0;            ///< of the sphere [m]
  std::vector<TestPlace> places;  ///< none of them is one where the library measures
};

/// Depths of the presses, relative to the radius.
inline constexpr std::array<double, 3> depths{1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0};

/// A press on the mesh as given.
struct Press {
  double force = 0.0;      ///< [N]
  double expected = 0.0;   ///< [N] ForceError
  double bound = 0.0;      ///< [N] ForceError, without the part for large strain: the truth is linear, too
  bool flagged = false;    ///< locking is reported by the set-up
  double recovered = 0.0;  ///< [N] the estimate of Zienkiewicz and Zhu instead of `expected`
};

/// Presses per place and depth, and the set-up.
struct Answer {
  std::vector<std::array<Press, depths.size()>> presses;
  double setup_seconds = 0.0, accuracy_seconds = 0.0, typical = 0.0, largest = 0.0;
  std::string remark;
  int nodes_per_element = 0;
  bool has_recovered = false;  ///< Press::recovered
};

/// Per place and depth [N].
using Forces = std::vector<std::array<double, depths.size()>>;

/// The organ, the organ with a lesion ten times as stiff, a block and a thin lobe.
std::vector<TestBody> test_bodies();
/// Mean over the touched faces of the square root of twice the area [m].
double mean_facet(const TestBody& body);
/// Points on the touched group, away from its rim by `margin` [m].
std::vector<TestPlace> places_on(const TestBody& body, double margin, unsigned seed, std::size_t count);

RegionMaterials<LinearElastic> materials_of(const Case& test);

/// Edges of the true mesh at the places, per radius.
inline constexpr double true_edges_per_radius = 5.0;
/// The forces of Tet10 on a mesh refined near the places.
Forces truth(const Case& test, double edges_per_radius = true_edges_per_radius);

/// Defined in one file per element.
template <class E>
Answer answer(const Case& test);

/// Ticks of two models of a block, with and without errors, in turn; prints the time of a tick.
void print_tick_cost();

}  // namespace force_error
