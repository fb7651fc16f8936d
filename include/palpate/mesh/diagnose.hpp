// Measures a mesh: indices, positions, orientation, quality, duplicates, orphans, components, units.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/components.hpp>
#include <palpate/mesh/diagnosis.hpp>
#include <palpate/mesh/duplicates.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Refuses an owning mesh whose region array does not fit its elements; views hide their arrays and are trusted.
template <class M>
void require_region_array(const M& mesh) {
  if constexpr (requires { mesh.regions.size() + mesh.elements.size(); })
    if (!mesh.regions.empty() && mesh.regions.size() != mesh.elements.size())
      raise(SetupErrorKind::bad_argument, "regions holds " + std::to_string(mesh.regions.size()) + " numbers",
            "It needs one per element, " + std::to_string(mesh.elements.size()) + ", or none");
}

/// Node ids and regions; an element is listed once, with its first bad number.
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

/// Finite positions, bounding box and units.
template <MeshView M>
void check_positions(const M& mesh, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  constexpr double bound = 1e100;
  d.box_min.setConstant(infinity);
  d.box_max.setConstant(-infinity);
  for (Index i = 0; i < d.node_count; ++i) {
    const Vector3 x = mesh.position(i);
    if (!(std::abs(x[0]) < bound && std::abs(x[1]) < bound && std::abs(x[2]) < bound)) {
      d.non_finite.add(i, x.sum(), bound);
      continue;
    }
    d.box_min = d.box_min.cwiseMin(x);
    d.box_max = d.box_max.cwiseMax(x);
  }
  if (d.non_finite || d.node_count == 0) {
    d.box_min.setZero();
    d.box_max.setZero();
    return;
  }
  d.diagonal = (d.box_max - d.box_min).norm();
  const double farthest = std::max(d.box_min.cwiseAbs().maxCoeff(), d.box_max.cwiseAbs().maxCoeff());
  d.offset_ratio = d.diagonal > 0.0 ? farthest / d.diagonal : 0.0;
  d.looks_like_millimetres = d.diagonal > thresholds.millimetres;
  if (d.looks_like_millimetres) d.units = {1, {}, {}, d.diagonal, thresholds.millimetres};
}

/// -1 inverted, 0 flat, 1 sound.
int orientation(const ElementShape& shape, const MeshThresholds& thresholds) noexcept;

/// Puts one element in its categories. Inverted and flat elements are no slivers besides.
void classify(Index e, const ElementShape& shape, const MeshThresholds& thresholds, MeshDiagnosis& d);

template <Element E, MeshOf<E> M>
void check_elements(const M& mesh, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  d.min_quality = 1.0;
  for (Index e = 0; e < d.element_count; ++e) classify(e, element_shape<E>(element_nodes<E>(mesh, e)), thresholds, d);
  d.mean_quality /= static_cast<double>(d.element_count);
}

template <Element E, MeshOf<E> M>
void check_duplicates(const M& mesh, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  const CoincidentNodes coincident = coincident_nodes<E>(mesh, thresholds.coincidence);
  for (Index i = 0; i < d.node_count; ++i)
    if (coincident.representative[static_cast<std::size_t>(i)] != i)
      d.duplicate_nodes.add(i, coincident.distance[static_cast<std::size_t>(i)], thresholds.coincidence);
  const std::vector<Index> first = first_equal_elements<E>(mesh);
  for (Index e = 0; e < d.element_count; ++e)
    if (first[static_cast<std::size_t>(e)] != e)
      d.duplicate_elements.add(e, static_cast<double>(first[static_cast<std::size_t>(e)]), 0.0);
}

template <Element E, MeshOf<E> M>
void check_connection(const M& mesh, MeshDiagnosis& d) {
  const MeshComponents components = connected_components<E>(mesh);
  d.component_count = components.count;
  std::vector<Index> first(static_cast<std::size_t>(components.count), -1), size(first.size(), 0);
  for (Index i = 0; i < d.node_count; ++i) {
    const NodeId component = components.of_node[static_cast<std::size_t>(i)];
    if (component < 0) {
      d.orphans.add(i, 0.0, 0.0);
      continue;
    }
    const auto c = static_cast<std::size_t>(component);
    if (size[c]++ == 0) first[c] = i;
  }
  if (components.count > 1)
    for (std::size_t c = 0; c < first.size(); ++c) d.disconnected.add(first[c], static_cast<double>(size[c]), 1.0);
}

}  // namespace detail

/// Measures a mesh without changing it. Indices and positions are checked first; if one is unusable the rest is left
/// out (`MeshDiagnosis::complete`). Throws bad_argument for an owning mesh whose `regions` has the wrong length,
/// count_too_large beyond 2^31 - 1 nodes. O(n log n) in nodes and elements, allocates; a million tetrahedra take about
/// half a second.
template <Element E, MeshOf<E> M>
MeshDiagnosis diagnose(const M& mesh, const MeshThresholds& thresholds = {}) {
  detail::require_region_array(mesh);
  MeshDiagnosis d;
  d.node_count = static_cast<Index>(mesh.node_count());
  d.element_count = static_cast<Index>(mesh.element_count());
  if (d.node_count > std::numeric_limits<NodeId>::max())
    raise(SetupErrorKind::count_too_large, std::to_string(d.node_count) + " nodes", "Node ids have 32 bits");
  detail::check_indices<E>(mesh, d);
  detail::check_positions(mesh, thresholds, d);
  d.complete = !d.empty() && !d.index_out_of_range && !d.non_finite;
  if (!d.complete) return d;
  detail::check_elements<E>(mesh, thresholds, d);
  detail::check_duplicates<E>(mesh, thresholds, d);
  detail::check_connection<E>(mesh, d);
  return d;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/diagnose.ipp>
#endif
