// Measures a mesh: indices, positions, orientation, quality, duplicates, orphans, components, units.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/diagnosis.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/quality.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Refuses an owning mesh whose region array does not match the number of elements.
void require_region_array(std::size_t regions, std::size_t elements);

/// A diagnosis with these counts. Throws count_too_large.
MeshDiagnosis begin_diagnosis(Index node_count, Index element_count);

/// Checks node ids and regions of a view without public arrays, in the view's integer types; an element is listed once,
/// with its first bad number.
template <Element E, MeshOf<E> M>
void check_indices(const M& mesh, MeshDiagnosis& d) {
  const auto regions = static_cast<Index>(mesh.region_count());
  for (Index e = 0; e < d.element_count; ++e) {
    auto id = static_cast<Index>(mesh.region(e));
    Index bound = regions;
    bool fine = id >= 0 && id < bound;
    for (int a = 0; a < E::nodes && fine; ++a) {
      id = static_cast<Index>(mesh.element_node(e, a));
      bound = d.node_count;
      fine = id >= 0 && id < bound;
    }
    if (!fine) d.index_out_of_range.add(e, static_cast<double>(id), static_cast<double>(bound));
  }
}
/// The same for the arrays of a mesh.
void check_indices(const MeshRef& mesh, MeshDiagnosis& d);

/// All checks after those of the indices.
void diagnose_rest(const MeshRef& mesh, ShapeOfElement shape_of, const MeshThresholds& thresholds, MeshDiagnosis& d);

/// -1 inverted, 0 flat, 1 sound.
int orientation(const ElementShape& shape, const MeshThresholds& thresholds) noexcept;

}  // namespace detail

/// Measures a mesh without changing it. Indices and positions are checked first; if one is unusable, the other checks
/// are skipped (`MeshDiagnosis::complete`). Throws bad_argument for an owning mesh whose `regions` has the wrong
/// length, count_too_large beyond 2^31 - 1 nodes. O(n log n) in nodes and elements, allocates; a million tetrahedra
/// take about half a second.
template <Element E, MeshOf<E> M>
MeshDiagnosis diagnose(const M& mesh, const MeshThresholds& thresholds = {}) {
  if constexpr (requires { mesh.regions.size() + mesh.elements.size(); })  // views have no public arrays to check
    detail::require_region_array(mesh.regions.size(), mesh.elements.size());
  MeshDiagnosis d = detail::begin_diagnosis(static_cast<Index>(mesh.node_count()),  //
                                            static_cast<Index>(mesh.element_count()));
  const detail::PlainView view = detail::plain_view<E>(mesh);
  if constexpr (detail::is_mesh<M>)
    detail::check_indices(view.mesh, d);
  else
    detail::check_indices<E>(mesh, d);
  detail::diagnose_rest(view.mesh, detail::shape_of_element<E>, thresholds, d);
  return d;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/diagnose.ipp>
#endif
