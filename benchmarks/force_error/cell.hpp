// One case of the table: a body, a Poisson ratio, a radius, a length of facets; the truth and the answers of models.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/scene.hpp>

#include <array>
#include <functional>
#include <string>
#include <vector>

namespace force_error {

using namespace palpate;

/// A place where a tool is pressed: a point of the surface and the outward normal.
struct TestPlace {
  Vector3 point, outward;
};

/// A body that is fixed and touched at parts of its mesh.
struct TestBody {
  std::string name;
  Selection fixed, touched;
  Mesh<Tet4> tetrahedra;
  /// The same body of hexahedra with edges of about this length [m]; empty: none.
  std::function<Mesh<Hex8>(double)> hexahedra{};
  double stiff_region = 1.0;   ///< modulus of the organ's lesion relative to the rest
  Vector3 edge_a{}, edge_b{};  ///< an edge of the body: places are beside it; equal: places are away from rims
};

/// What is varied.
struct Case {
  const TestBody& body;
  double poisson_ratio = 0.0;
  double radius = 0.0;            ///< of the tool [m]
  double facet = 0.0;             ///< edges near the places [m]; longer than those of the mesh: as given
  std::vector<TestPlace> places;  ///< none of them is one where the library measures
  bool all_tools = false;         ///< capsule and plate, too
};

/// Sphere, capsule (twice as long as wide), plate (two radii wide, one thick, with round edges), in the order of the
/// answers.
inline constexpr std::array<const char*, 3> tool_names{"sphere", "capsule", "plate"};
Tool tool_of(std::size_t number, double radius);
/// How far the tool's surface is below its position [m].
double reach_of(std::size_t number, double radius);
inline std::size_t tools_of(const Case& test) {
  return test.all_tools ? tool_names.size() : 1;
}

/// Depths of the presses, relative to the radius.
inline constexpr std::array<double, 4> depths{1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0};

/// A press.
struct Press {
  double force = 0.0;    ///< [N]
  double bound = 0.0;    ///< [N] ForceError, without the part for large strain: the truth is linear, too
  bool flagged = false;  ///< by the tick
};

/// Per tool, place and depth.
using Presses = std::vector<std::vector<std::array<Press, depths.size()>>>;

/// The answer of a model with default options, and of one that measures its error.
struct Answer {
  Presses presses, measured;  ///< measured: empty unless asked for
  bool locks = false;         ///< the set-up reports that the element locks
  double setup_seconds = 0.0;
};

/// The organ, the organ with a lesion ten times as stiff, a block, a thin lobe, a round body, the edge of a block.
std::vector<TestBody> test_bodies();
/// Mean over the touched faces of the square root of twice the area [m].
double mean_facet(const TestBody& body);
/// Points of the touched part, away from its rim by `margin` [m]; on a body with an edge less than a radius from it.
std::vector<TestPlace> places_on(const TestBody& body, double radius, double margin, unsigned seed, std::size_t count);

RegionMaterials<LinearElastic> materials_of(const Case& test);
/// The mesh with the facets of the case at its places.
Mesh<Tet4> tetrahedra_of(const Case& test);

/// Edges of the true mesh at the places, per radius.
inline constexpr double true_edges_per_radius = 5.0, true_edges_per_radius_of_plates = 7.0;
/// The forces of Tet10 on meshes refined below each tool, with the compliance of that mesh alone. `finer`: edges
/// shorter by this factor.
Presses truth(const Case& test, double finer = 1.0);

/// Defined in one file per element.
template <class E>
Answer answer(const Case& test, bool measure);

/// Ticks of two models of a block, with and without errors, in turn; prints the time of a tick.
void print_tick_cost();

}  // namespace force_error
