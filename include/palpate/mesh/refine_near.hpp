// Local refinement of tetrahedra towards a wanted edge length: near points, parts of the mesh, or what a scene touches.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/refine_target.hpp>
#include <palpate/mesh/scene.hpp>

#include <concepts>
#include <functional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Wanted edge length [m] at a distance [m] from the targets: edge + growth * distance. Both positive and finite.
struct WantedEdge {
  double edge = 0.0;
  double growth = 0.35;
};

/// Wanted edge length [m] at a point of the mesh as given [m]: positive, infinity where nothing is to be refined.
using EdgeField = std::function<double(const Vector3&)>;

}  // namespace detail

struct RefineNearOptions {
  Index most_nodes = 1'000'000;  ///< refinement ends when the mesh has this number of nodes
  /// No element gets a quality below this fraction of the least quality in the mesh as given; 0 < fraction <= 1.
  double quality_kept = 0.5;
  /// New nodes on the boundary are moved onto this surface as far as the quality allows, and by at most half the length
  /// of the edge that they divide; nullptr: edges stay straight. Nodes of the mesh as given are not moved.
  const detail::CurvedSurface* surface = nullptr;
};

/// What refine_near did. Quality is the mean ratio of mesh/quality.hpp.
struct RefineNearReport {
  Index nodes_before = 0, nodes_after = 0, elements_before = 0, elements_after = 0;
  double least_quality_before = 0.0, least_quality_after = 0.0;
  double mean_quality_before = 0.0, mean_quality_after = 0.0;
  double shortest_edge = 0.0;        ///< [m]
  Index edges_too_long = 0;          ///< longer than wanted at their middle; 0: the wanted length is reached
  double worst_excess = 0.0;         ///< largest ratio of length and wanted length of these, or 0
  bool most_nodes_reached = false;   ///< whether `most_nodes` ended the refinement
  Index curved_nodes = 0;            ///< new nodes on the boundary, if a surface is given
  double distance_to_surface = 0.0;  ///< largest distance of these nodes to the surface [m]

  bool reached() const noexcept { return edges_too_long == 0; }
};

/// The same body with edges no longer than wanted near the targets, by bisection of longest edges (Rivara 1984): an
/// edge is divided in its middle together with all elements around it, after all longer edges of these elements. The
/// mesh conforms, elements keep their orientation, nodes keep their ids and new ones follow; the elements that replace
/// element e stand in its place. Regions, fibres and groups are transferred. A group's faces and elements are replaced
/// by their parts; it gains the nodes on its faces and in its elements, a group of lines those on edges between two of
/// its nodes. A group that contains only nodes gains those on boundary faces all of whose nodes it contains, and, if it
/// contains a node inside the body, those in elements all of whose nodes it contains; an edge through the body between
/// two of its nodes adds none. The result does not depend on the numbering, except for the order of nodes and elements.
///
/// Throws bad_argument for a wanted edge or option out of range, for targets that are empty or farther from the mesh
/// than its diagonal; unknown_group, empty_group, index_out_of_range as `resolve_nodes`; non_finite; inverted_element
/// or degenerate_element for elements without positive volume; unsupported for a group's face that no element has;
/// if no report is asked for, too_large where `most_nodes` ended the refinement, and poor_quality where no division
/// keeps the quality. O(elements) + O(new nodes), with a logarithm; allocates.
Mesh<Tet4> refine_near(const Mesh<Tet4>& mesh, const std::vector<RefineTarget>& targets,
                       const detail::WantedEdge& wanted, const RefineNearOptions& options = {},
                       RefineNearReport* report = nullptr);

/// The same near one target.
Mesh<Tet4> refine_near(const Mesh<Tet4>& mesh, const RefineTarget& target, const detail::WantedEdge& wanted,
                       const RefineNearOptions& options = {}, RefineNearReport* report = nullptr);

/// The same for any wanted edge length, which is evaluated at the middle of edges. Throws bad_argument where the field
/// returns NaN or a number that is not positive.
Mesh<Tet4> refine_near(const Mesh<Tet4>& mesh, const detail::EdgeField& wanted, const RefineNearOptions& options = {},
                       RefineNearReport* report = nullptr);

namespace detail {

template <class E>
inline constexpr bool is_bisected = std::same_as<E, Tet4>;

}  // namespace detail

/// Other elements are refused by the compiler.
template <Element E>
requires(!detail::is_bisected<E>) Mesh<E> refine_near(const Mesh<E>&, const std::vector<RefineTarget>&,
                                                      const detail::WantedEdge&, const RefineNearOptions& = {},
                                                      RefineNearReport* = nullptr) {
  static_assert(detail::is_bisected<E>,
                "palpate: refine_near divides linear tetrahedra. Quadratic ones: refine the Mesh<Tet4>, then "
                "promote<Tet10>. Hexahedra: mesh the body with tetrahedra, or with smaller hexahedra");
}
template <Element E>
requires(!detail::is_bisected<E>) Mesh<E> refine_near(const Mesh<E>& mesh, const RefineTarget& target,
                                                      const detail::WantedEdge& wanted,
                                                      const RefineNearOptions& options = {},
                                                      RefineNearReport* report = nullptr) {
  return refine_near(mesh, std::vector<RefineTarget>{target}, wanted, options, report);
}
template <Element E>
requires(!detail::is_bisected<E>) Mesh<E> refine_near(const Mesh<E>& mesh, const detail::EdgeField&,
                                                      const RefineNearOptions& options = {},
                                                      RefineNearReport* report = nullptr) {
  return refine_near(mesh, std::vector<RefineTarget>{}, {}, options, report);
}

namespace detail {

/// Whether a scene selects anything by a list of nodes. Refinement adds nodes to groups, not to lists.
bool lists_nodes(const Scene& scene);

}  // namespace detail

/// Replaces the listed nodes of a scene by new groups of the mesh, "listed nodes 1" and so on, and returns that scene.
/// They contain the boundary faces all of whose nodes are listed, and with a node inside the body the elements, too:
/// `refine_near` and `promote` add the new nodes on these. Throws index_out_of_range for a node that the mesh does not
/// have.
Scene name_listed_nodes(Mesh<Tet4>& mesh, const Scene& scene);

/// The mesh with edges of at most `edge` [m] on the touchable part of a scene, longer ones with the distance. Of a set
/// of points (mesh/where.hpp) the part is where the surface is inside it, whatever nodes are there. Throws unsupported
/// for a scene that lists nodes: use `name_listed_nodes` first; bad_argument for a scene that is not touched; the
/// errors of `refine_near`.
Mesh<Tet4> refine_near_touched(const Mesh<Tet4>& mesh, const Scene& scene, double edge,
                               const RefineNearOptions& options = {}, RefineNearReport* report = nullptr);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/refine_near.ipp>
#endif
