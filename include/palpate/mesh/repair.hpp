// Changes to an owning mesh that keep its groups and regions in step.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <array>
#include <optional>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Renumbers a group's nodes and faces. A face that lost a node, has two nodes fallen together, or repeats an earlier
/// face is dropped.
void renumber_group(Group& group, const std::vector<NodeId>& map);

}  // namespace detail

/// Gives node i the id `map[i]`, or drops it when that is -1; several nodes may share an id, the first gives the
/// position. The ids that occur must be 0, 1, 2 ... without a gap, and no element may use a dropped node. O(nodes +
/// elements + groups).
template <Element E>
void renumber_nodes(Mesh<E>& mesh, const std::vector<NodeId>& map) {
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) continue;
    const auto to = static_cast<std::size_t>(map[i]);
    if (to >= positions.size()) positions.resize(to + 1, Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    if (!(positions[to][0] == positions[to][0])) positions[to] = mesh.positions[i];
  }
  mesh.positions = std::move(positions);
  for (auto& element : mesh.elements)
    for (NodeId& i : element) i = map[static_cast<std::size_t>(i)];
  for (Group& group : mesh.groups.all()) detail::renumber_group(group, map);
}

/// Gives element e the id `map[e]`, or drops it when that is -1. The map must keep the order. O(elements + groups).
template <Element E>
void renumber_elements(Mesh<E>& mesh, const std::vector<Index>& map) {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < map.size(); ++e) {
    if (map[e] < 0) continue;
    mesh.elements[kept] = mesh.elements[e];
    if (!mesh.regions.empty()) mesh.regions[kept] = mesh.regions[e];
    if (mesh.has_fibres()) mesh.fibres[kept] = mesh.fibres[e];
    ++kept;
  }
  mesh.elements.resize(kept);
  if (!mesh.regions.empty()) mesh.regions.resize(kept);
  if (mesh.has_fibres()) mesh.fibres.resize(kept);
  for (Group& group : mesh.groups.all()) {
    std::vector<Index> elements;
    for (Index e : group.elements)
      if (const Index to = map[static_cast<std::size_t>(e)]; to >= 0) elements.push_back(to);
    group.elements = std::move(elements);
  }
}

/// Order of the nodes in which an element is its own mirror image (first two reference axes swapped): turns the sign of
/// its Jacobian. Nothing when the reference element is not symmetric in these axes.
template <Element E>
std::optional<std::array<int, static_cast<std::size_t>(E::nodes)>> mirrored_order() {
  const auto x = E::reference_nodes();
  std::array<int, static_cast<std::size_t>(E::nodes)> order{};
  for (int a = 0; a < E::nodes; ++a) {
    int found = -1;
    for (int b = 0; b < E::nodes && found < 0; ++b) {
      const Vector3 difference(x(a, 0) - x(b, 1), x(a, 1) - x(b, 0), x(a, 2) - x(b, 2));
      if (difference.cwiseAbs().maxCoeff() < 1e-9) found = b;
    }
    if (found < 0) return std::nullopt;
    order[static_cast<std::size_t>(a)] = found;
  }
  return order;
}

/// Reorders the nodes of the given elements into their mirror image. Tet4: swaps its second and third node. Refuses an
/// element type without such an order as unsupported.
template <Element E>
void reorient(Mesh<E>& mesh, const std::vector<Index>& elements) {
  const auto order = mirrored_order<E>();
  if (!order)
    raise(SetupErrorKind::unsupported, "elements of this type cannot be turned round",
          "Mend the mesh where it was made");
  for (Index e : elements) {
    auto& nodes = mesh.elements[static_cast<std::size_t>(e)];
    const auto old = nodes;
    for (std::size_t a = 0; a < nodes.size(); ++a) nodes[a] = old[static_cast<std::size_t>((*order)[a])];
  }
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/repair.ipp>
#endif
