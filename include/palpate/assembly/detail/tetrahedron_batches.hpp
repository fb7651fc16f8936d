// Memory layout of tetrahedra in batches of lanes, for a force that is computed every tick.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/tetrahedron_batch.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/detail/lane_rows.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <numeric>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Neighbouring elements of one region.
struct ElementBlock {
  int region = 0;
  std::vector<NodeId> elements;  ///< element ids
};

/// Bisects along the longest side of the bounding box of the centres until a part has at most `most` elements. Cuts
/// are at multiples of `group`.
inline void bisect_elements(std::span<NodeId> elements, const std::vector<Vector3>& centre, Index most, Index group,
                            int region, std::vector<ElementBlock>& blocks) {
  const auto count = static_cast<Index>(elements.size());
  if (count <= most) {
    blocks.push_back({region, {elements.begin(), elements.end()}});
    return;
  }
  Box box;
  for (NodeId e : elements) box.include(centre[static_cast<std::size_t>(e)]);
  const Vector3 size = box.size();
  int axis = 0;
  for (int c = 1; c < 3; ++c)
    if (size[c] > size[axis]) axis = c;
  const Index half = std::max(group, (count / 2 + group / 2) / group * group);
  const auto before = [&](NodeId a, NodeId b) {
    const double xa = centre[static_cast<std::size_t>(a)][axis], xb = centre[static_cast<std::size_t>(b)][axis];
    return xa < xb || (xa == xb && a < b);
  };
  std::nth_element(elements.begin(), elements.begin() + half, elements.end(), before);
  const auto middle = static_cast<std::size_t>(half);
  bisect_elements(elements.subspan(0, middle), centre, most, group, region, blocks);
  bisect_elements(elements.subspan(middle), centre, most, group, region, blocks);
}

/// Divides a mesh into blocks of at most `most` elements, all but the last of a region a multiple of `group`.
/// Deterministic for a given mesh. O(elements log elements).
template <Element E>
std::vector<ElementBlock> element_blocks(const Mesh<E>& mesh, Index most, Index group) {
  std::vector<Vector3> centre;
  std::vector<std::vector<NodeId>> of_region(static_cast<std::size_t>(mesh.region_count()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(mesh, e);
    Vector3 sum = Vector3::Zero();
    for (int a = 0; a < E::nodes; ++a)
      for (int c = 0; c < 3; ++c) sum[c] += x.coeff(a, c);
    centre.push_back(sum / double{E::nodes});
    of_region[static_cast<std::size_t>(mesh.region(e))].push_back(static_cast<NodeId>(e));
  }
  std::vector<ElementBlock> blocks;
  for (std::size_t r = 0; r < of_region.size(); ++r)
    if (!of_region[r].empty()) bisect_elements(of_region[r], centre, most, group, static_cast<int>(r), blocks);
  for (ElementBlock& block : blocks) std::ranges::sort(block.elements);
  return blocks;
}

/// Tet4, or Tet4 with smoothed strain.
template <class E>
concept LinearTetrahedron = Element<E> && E::nodes == 4 && E::order == 1;

/// A part of the mesh whose nodal values fit into the first-level cache.
struct TetrahedronBlock {
  Index first_batch = 0, batch_count = 0;
  Index first_row = 0, row_count = 0;  ///< its nodes, in TetrahedronBatches::nodes
  int region = 0;
};

/// All batches of a mesh and the positions of its nodes in the blocks. 88 bytes per element in double, 48 in float;
/// about two rows per node.
template <class S, int N>
struct TetrahedronBatches {
  static constexpr Index elements_per_block = tetrahedra_per_block;
  static constexpr Index most_rows = 4 * elements_per_block;

  std::vector<TetrahedronBatch<S, N>> batches;
  std::vector<std::array<NodeId, static_cast<std::size_t>(N)>> elements;  ///< of every batch; -1 in an empty lane
  std::vector<TetrahedronBlock> blocks;
  std::vector<NodeId> nodes;         ///< of every row
  std::vector<Index> first_copy;     ///< rows of node i: copies first_copy[i] to first_copy[i + 1]
  std::vector<std::int32_t> copies;  ///< rows by node, ascending

  TetrahedronBatches() = default;
  /// Throws inverted_element or non_finite, with the element's id.
  template <LinearTetrahedron E>
  explicit TetrahedronBatches(const Mesh<E>& mesh) {
    for (const ElementBlock& block : element_blocks(mesh, elements_per_block, N)) add_block(mesh, block);
    list_copies(mesh.node_count());
  }

  Index node_count() const noexcept { return static_cast<Index>(first_copy.size()) - 1; }

  /// Removes the elements for which gone(element) is true: their lanes become empty. O(elements), no
  /// allocation.
  template <class Gone>
  void remove_if(Gone&& gone) {
    for (std::size_t b = 0; b < batches.size(); ++b)
      for (int lane = 0; lane < N; ++lane) {
        NodeId& e = elements[b][static_cast<std::size_t>(lane)];
        if (e < 0 || !gone(Index{e})) continue;
        e = -1;
        for (Triple<Lanes<S, N>>& g : batches[b].gradient)
          for (Lanes<S, N>* x : {&g.x, &g.y, &g.z}) x->set(lane, S(0));
        batches[b].volume.set(lane, S(0));
      }
  }
  /// Takes in the nodes of a mesh whose elements have kept their ids and shapes. `changed(batch)` is true for batches
  /// with elements that were removed, or have other nodes. O(rows), and O(elements) of their blocks.
  template <LinearTetrahedron E, class Changed>
  void reconnect(const Mesh<E>& mesh, Changed&& changed) {
    std::vector<NodeId> rows;
    rows.reserve(nodes.size() + 64);
    for (TetrahedronBlock& block : blocks) {
      const auto old = nodes.begin() + block.first_row;
      std::vector<NodeId> local;
      for (Index b = block.first_batch; b < block.first_batch + block.batch_count && local.empty(); ++b)
        if (changed(b)) local = nodes_of(mesh, block);
      block.first_row = static_cast<Index>(rows.size());
      if (local.empty()) {  // no change, or no element is left
        rows.insert(rows.end(), old, old + block.row_count);
        continue;
      }
      block.row_count = static_cast<Index>(local.size());
      rows.insert(rows.end(), local.begin(), local.end());
      for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b)
        for (int lane = 0; lane < N; ++lane)
          set_rows(batches[static_cast<std::size_t>(b)], lane, mesh,
                   elements[static_cast<std::size_t>(b)][static_cast<std::size_t>(lane)], local);
    }
    nodes.swap(rows);
    list_copies(mesh.node_count());
  }

  /// As detail::load_relative.
  void load_displacements(const TetrahedronBlock& block, const VectorX& u, S* local) const noexcept {
    load_relative(nodes.data() + block.first_row, block.row_count, u.data(), local);
  }
  /// Calls visit(batch, F) for every batch of a block at a displacement.
  template <class Visit>
  PALPATE_ALWAYS_INLINE void for_each_gradient(const TetrahedronBlock& block, const VectorX& u,
                                               Visit&& visit) const noexcept {
    alignas(64) S local[4 * most_rows];
    load_displacements(block, u, local);
    for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b) {
      const TetrahedronBatch<S, N>& batch = batches[static_cast<std::size_t>(b)];
      visit(batch, batch.deformation_gradient(local));
    }
  }
  /// The rows of a block, set to zero.
  static S* cleared(const TetrahedronBlock& block, std::vector<S>& rows) noexcept {
    S* const first = rows.data() + 4 * block.first_row;
    std::fill(first, first + 4 * block.row_count, S(0));
    return first;
  }
  /// Sets f, for every node of a range, to the sum of its rows of four numbers.
  void add_up(const S* rows, Index first_node, Index last_node, VectorX& f) const noexcept {
    for (Index i = first_node; i < last_node; ++i) {
      double sum[3] = {0.0, 0.0, 0.0};
      for (Index k = first_copy[static_cast<std::size_t>(i)]; k < first_copy[static_cast<std::size_t>(i) + 1]; ++k) {
        const S* row = rows + 4 * Index{copies[static_cast<std::size_t>(k)]};
        for (int c = 0; c < 3; ++c) sum[c] += static_cast<double>(row[c]);
      }
      for (int c = 0; c < 3; ++c) f[3 * i + c] = sum[c];
    }
  }

 private:
  template <class E>
  void add_block(const Mesh<E>& mesh, const ElementBlock& block) {
    const auto count = static_cast<Index>(block.elements.size()), groups = (count + N - 1) / N;
    const std::vector<NodeId> local = nodes_of(mesh, block);
    blocks.push_back({static_cast<Index>(batches.size()), groups, static_cast<Index>(nodes.size()),
                      static_cast<Index>(local.size()), block.region});
    nodes.insert(nodes.end(), local.begin(), local.end());
    for (Index b = 0; b < groups; ++b) {
      TetrahedronBatch<S, N>& batch = batches.emplace_back(TetrahedronBatch<S, N>{});
      elements.emplace_back().fill(-1);
      // lanes are far apart in the block, so that few consecutive lanes add to the same node
      for (Index lane = 0; lane < N; ++lane)
        if (const Index at = lane * groups + b; at < count) {
          const NodeId e = block.elements[static_cast<std::size_t>(at)];
          elements.back()[static_cast<std::size_t>(lane)] = e;
          set_lane(batch, static_cast<int>(lane), mesh, e, local);
        }
    }
  }
  void list_copies(Index node_count) {
    first_copy.assign(static_cast<std::size_t>(node_count) + 1, 0);
    for (NodeId node : nodes) ++first_copy[static_cast<std::size_t>(node) + 1];
    std::partial_sum(first_copy.begin(), first_copy.end(), first_copy.begin());
    std::vector<Index> next(first_copy.begin(), first_copy.end() - 1);
    copies.resize(nodes.size());
    for (std::size_t r = 0; r < nodes.size(); ++r)
      copies[static_cast<std::size_t>(next[static_cast<std::size_t>(nodes[r])]++)] = static_cast<std::int32_t>(r);
  }
  template <class E>
  static std::vector<NodeId> nodes_of(const Mesh<E>& mesh, const ElementBlock& block) {
    std::vector<NodeId> local;
    for (NodeId e : block.elements)
      for (int a = 0; a < 4; ++a) local.push_back(mesh.element_node(e, a));
    std::ranges::sort(local);
    local.erase(std::unique(local.begin(), local.end()), local.end());
    return local;
  }
  /// Of the elements that are left.
  template <class E>
  std::vector<NodeId> nodes_of(const Mesh<E>& mesh, const TetrahedronBlock& block) const {
    ElementBlock left;
    for (Index b = block.first_batch; b < block.first_batch + block.batch_count; ++b)
      for (const NodeId e : elements[static_cast<std::size_t>(b)])
        if (e >= 0) left.elements.push_back(e);
    return nodes_of(mesh, left);
  }
  template <class E>
  static void set_lane(TetrahedronBatch<S, N>& batch, int lane, const Mesh<E>& mesh, Index e,
                       const std::vector<NodeId>& local) {
    const PointGeometry<E> g = constant_geometry(mesh, e);
    for (int a = 0; a < 3; ++a) {
      batch.gradient[a].x.set(lane, static_cast<S>(g.gradient(a + 1, 0)));
      batch.gradient[a].y.set(lane, static_cast<S>(g.gradient(a + 1, 1)));
      batch.gradient[a].z.set(lane, static_cast<S>(g.gradient(a + 1, 2)));
    }
    batch.volume.set(lane, static_cast<S>(g.volume));
    set_rows(batch, lane, mesh, e, local);
  }
  /// `e` is -1 for an empty lane.
  template <class E>
  static void set_rows(TetrahedronBatch<S, N>& batch, int lane, const Mesh<E>& mesh, Index e,
                       const std::vector<NodeId>& local) {
    for (int a = 0; a < 4; ++a) {
      const auto at = e < 0 ? 0 : std::ranges::lower_bound(local, mesh.element_node(e, a)) - local.begin();
      batch.row[a][lane] = static_cast<std::uint16_t>(4 * at);
    }
  }
};

/// The batches of a body, after check() of its materials. Throws inverted_element, non_finite, unsupported for a
/// material with fibres on a mesh with fibre directions, too_large, or the problem of a material's check().
template <class S, int N, LinearTetrahedron E, HyperelasticMaterial M>
TetrahedronBatches<S, N> make_batches(const HyperelasticBody<E, M>& body, double bytes_per_element,
                                      const SetupLimits& limits) {
  for (const M& material : body.materials)
    if (auto problem = material.check()) raise(std::move(*problem));
  require_no_fibres(body);
  limits.require_memory(static_cast<double>(body.rest.mesh.element_count()) * bytes_per_element,
                        "the batches of elements");
  return TetrahedronBatches<S, N>(body.rest.mesh);
}

}}}  // namespace palpate::detail
