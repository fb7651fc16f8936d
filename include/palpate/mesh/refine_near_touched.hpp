// Refinement of tetrahedra where a scene is touched.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/scene.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Whether a scene selects anything by a list of nodes. Refinement adds nodes to groups, not to lists.
bool lists_nodes(const Scene& scene);

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
#include <palpate/mesh/refine_near_touched.ipp>
#endif
