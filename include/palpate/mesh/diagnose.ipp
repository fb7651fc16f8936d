// Definitions of diagnose.hpp.
#pragma once

#include <palpate/core/detail/box.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/mesh/detail/duplicates.hpp>
#include <palpate/mesh/diagnose.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE int orientation(const ElementShape& shape, const MeshThresholds& thresholds) noexcept {
  if (std::abs(shape.relative_volume) <= thresholds.degenerate + shape.resolution) return 0;
  return shape.relative_volume < 0.0 ? -1 : 1;
}

/// Adds one element to its categories. Inverted and flat elements are not also counted as slivers.
inline void classify(Index e, const ElementShape& shape, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  d.volume += shape.volume;
  d.min_quality = std::min(d.min_quality, shape.quality);
  d.mean_quality += shape.quality;
  ++d.quality_histogram[static_cast<std::size_t>(std::clamp(shape.quality * 10.0, 0.0, 9.0))];
  const int sign = orientation(shape, thresholds);
  if (sign == 0) return d.degenerate.add(e, shape.relative_volume, thresholds.degenerate + shape.resolution);
  if (sign < 0) return d.inverted.add(e, shape.relative_volume, 0.0);
  if (shape.quality < thresholds.poor_quality) d.poor_quality.add(e, shape.quality, thresholds.poor_quality);
  if (shape.quality < thresholds.quality_floor) d.slivers.add(e, shape.quality, thresholds.quality_floor);
}

PALPATE_INLINE void require_region_array(std::size_t regions, std::size_t elements) {
  if (regions != 0 && regions != elements)
    raise(SetupErrorKind::bad_argument, "regions holds " + std::to_string(regions) + " numbers",
          "It needs one per element, " + std::to_string(elements) + ", or none");
}

PALPATE_INLINE MeshDiagnosis begin_diagnosis(Index node_count, Index element_count) {
  MeshDiagnosis d;
  d.node_count = node_count;
  d.element_count = element_count;
  if (node_count > std::numeric_limits<NodeId>::max())
    raise(SetupErrorKind::count_too_large, std::to_string(node_count) + " nodes", "Node ids have 32 bits");
  return d;
}

PALPATE_INLINE void check_indices(const MeshRef& mesh, MeshDiagnosis& d) {
  const auto regions = static_cast<Index>(mesh.region_names.size());
  for (Index e = 0; e < d.element_count; ++e) {
    Index id = mesh.region(e);
    Index bound = regions;
    bool fine = id >= 0 && id < bound;
    const NodeId* nodes = mesh.nodes_of(e);
    for (int a = 0; a < mesh.element.nodes && fine; ++a) {
      id = nodes[a];
      bound = d.node_count;
      fine = id >= 0 && id < bound;
    }
    if (!fine) d.index_out_of_range.add(e, static_cast<double>(id), static_cast<double>(bound));
  }
}

/// Finite positions, bounding box and units.
inline void check_positions(const MeshRef& mesh, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  constexpr double bound = 1e100;
  Box box;
  for (Index i = 0; i < d.node_count; ++i) {
    const double* const at = mesh.position(i);
    const Vector3 x(at[0], at[1], at[2]);
    if (!(std::abs(x[0]) < bound && std::abs(x[1]) < bound && std::abs(x[2]) < bound)) {
      d.non_finite.add(i, x.sum(), bound);
      continue;
    }
    box.include(x);
  }
  if (d.non_finite || d.node_count == 0) {
    d.box_min.setZero();
    d.box_max.setZero();
    return;
  }
  d.box_min = box.low;
  d.box_max = box.high;
  d.diagonal = box.size().norm();
  const double farthest = std::max(max_abs(d.box_min), max_abs(d.box_max));
  d.offset_ratio = d.diagonal > 0.0 ? farthest / d.diagonal : 0.0;
  d.looks_like_millimetres = d.diagonal > thresholds.millimetres;
  if (d.looks_like_millimetres) d.units = {1, {}, {}, d.diagonal, thresholds.millimetres};
}

inline void check_elements(const MeshRef& mesh, ShapeOfElement shape_of, const MeshThresholds& thresholds,
                           MeshDiagnosis& d) {
  d.min_quality = 1.0;
  for (Index e = 0; e < d.element_count; ++e) classify(e, shape_of(mesh.positions, mesh.nodes_of(e)), thresholds, d);
  d.mean_quality /= static_cast<double>(d.element_count);
}

inline void check_duplicates(const MeshRef& mesh, const MeshThresholds& thresholds, MeshDiagnosis& d) {
  const CoincidentNodes coincident = coincident_nodes(mesh, thresholds.coincidence);
  for (Index i = 0; i < d.node_count; ++i)
    if (coincident.representative[static_cast<std::size_t>(i)] != i)
      d.duplicate_nodes.add(i, coincident.distance[static_cast<std::size_t>(i)], thresholds.coincidence);
  const std::vector<Index> first = first_equal_elements(mesh);
  for (Index e = 0; e < d.element_count; ++e)
    if (first[static_cast<std::size_t>(e)] != e)
      d.duplicate_elements.add(e, static_cast<double>(first[static_cast<std::size_t>(e)]), 0.0);
}

inline void check_connection(const MeshRef& mesh, MeshDiagnosis& d) {
  const MeshComponents components = connected_components(mesh);
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

PALPATE_INLINE void diagnose_rest(const MeshRef& mesh, ShapeOfElement shape_of, const MeshThresholds& thresholds,
                                  MeshDiagnosis& d) {
  check_positions(mesh, thresholds, d);
  d.complete = !d.empty() && !d.index_out_of_range && !d.non_finite;
  if (!d.complete) return;
  check_elements(mesh, shape_of, thresholds, d);
  check_duplicates(mesh, thresholds, d);
  check_connection(mesh, d);
}

}}}  // namespace palpate::detail
