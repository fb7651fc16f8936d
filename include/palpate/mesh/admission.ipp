// Definitions of admission.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/admission.hpp>
#include <palpate/mesh/detail/components.hpp>
#include <palpate/mesh/detail/duplicates.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Renumbers a group's nodes and faces. A face that lost a node, has two equal nodes, or repeats an earlier face is
/// dropped.
inline void renumber_group(Group& group, const std::vector<NodeId>& map) {
  std::vector<NodeId> nodes;
  for (NodeId i : group.nodes)
    if (const NodeId to = map[static_cast<std::size_t>(i)]; to >= 0) nodes.push_back(to);
  std::ranges::sort(nodes);
  nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
  group.nodes = std::move(nodes);
  std::set<std::vector<NodeId>> known;
  std::vector<std::vector<NodeId>> faces;
  for (std::vector<NodeId>& face : group.faces) {
    for (NodeId& i : face) i = map[static_cast<std::size_t>(i)];
    std::vector<NodeId> key = face;
    std::ranges::sort(key);
    const bool broken = !key.empty() && (key.front() < 0 || std::ranges::adjacent_find(key) != key.end());
    if (!broken && known.insert(std::move(key)).second) faces.push_back(std::move(face));
  }
  group.faces = std::move(faces);
}

PALPATE_INLINE void renumber_nodes(MeshEdit& mesh, const std::vector<NodeId>& map) {
  std::vector<Vector3> positions;
  for (std::size_t i = 0; i < map.size(); ++i) {
    if (map[i] < 0) continue;
    const auto to = static_cast<std::size_t>(map[i]);
    if (to >= positions.size()) positions.resize(to + 1, Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
    if (!(positions[to][0] == positions[to][0])) positions[to] = mesh.positions[i];
  }
  mesh.positions = std::move(positions);
  NodeId* const end = mesh.nodes_of(mesh.element_count);
  for (NodeId* node = mesh.connectivity; node != end; ++node) *node = map[static_cast<std::size_t>(*node)];
  for (Group& group : mesh.groups.all()) renumber_group(group, map);
}

PALPATE_INLINE void renumber_elements(MeshEdit& mesh, const std::vector<Index>& map) {
  std::size_t kept = 0;
  for (std::size_t e = 0; e < map.size(); ++e) {
    if (map[e] < 0) continue;
    const NodeId* nodes = mesh.nodes_of(static_cast<Index>(e));
    std::copy(nodes, nodes + mesh.element.nodes, mesh.nodes_of(static_cast<Index>(kept)));
    if (!mesh.regions.empty()) mesh.regions[kept] = mesh.regions[e];
    if (!mesh.fibres.empty()) mesh.fibres[kept] = mesh.fibres[e];
    ++kept;
  }
  mesh.element_count = static_cast<Index>(kept);
  if (!mesh.regions.empty()) mesh.regions.resize(kept);
  if (!mesh.fibres.empty()) mesh.fibres.resize(kept);
  for (Group& group : mesh.groups.all()) {
    std::vector<Index> elements;
    for (Index e : group.elements)
      if (const Index to = map[static_cast<std::size_t>(e)]; to >= 0) elements.push_back(to);
    group.elements = std::move(elements);
  }
}

PALPATE_INLINE std::optional<std::vector<int>> mirrored_order(const ElementLayout& element) {
  std::vector<double> x(3 * static_cast<std::size_t>(element.nodes));
  element.reference_nodes(x.data());
  const auto mirrors = [](const double* p, const double* q) {
    return std::abs(p[0] - q[1]) < 1e-9 && std::abs(p[1] - q[0]) < 1e-9 && std::abs(p[2] - q[2]) < 1e-9;
  };
  std::vector<int> order;
  for (int a = 0; a < element.nodes; ++a) {
    int b = 0;
    while (b < element.nodes && !mirrors(&x[static_cast<std::size_t>(3 * a)], &x[static_cast<std::size_t>(3 * b)])) ++b;
    if (b == element.nodes) return std::nullopt;
    order.push_back(b);
  }
  return order;
}

PALPATE_INLINE void reorient(MeshEdit& mesh, const std::vector<Index>& elements) {
  const auto order = mirrored_order(mesh.element);
  if (!order)
    raise(SetupErrorKind::unsupported, "elements of this type cannot be reversed",
          "Repair the mesh in the program that created it");
  for (Index e : elements) {
    NodeId* nodes = mesh.nodes_of(e);
    const std::vector<NodeId> old(nodes, nodes + mesh.element.nodes);
    for (std::size_t a = 0; a < old.size(); ++a) nodes[a] = old[static_cast<std::size_t>((*order)[a])];
  }
}

/// The inverse map; empty if nothing was renumbered.
template <class Id>
std::vector<std::int64_t> inverse_of(const std::vector<Id>& map) {
  std::vector<std::int64_t> origin;
  bool renumbered = false;
  for (std::size_t i = map.size(); i-- > 0;) {  // backwards, so that the lowest of several welded nodes is kept
    renumbered = renumbered || static_cast<std::int64_t>(map[i]) != static_cast<std::int64_t>(i);
    if (map[i] < 0) continue;
    const auto to = static_cast<std::size_t>(map[i]);
    if (to >= origin.size()) origin.resize(to + 1, -1);
    origin[to] = static_cast<std::int64_t>(i);
  }
  if (!renumbered) origin.clear();
  return origin;
}

PALPATE_INLINE void enforce(const MeshDiagnosis& d, const AdmissionPolicy& policy) {
  for (const AdmissionRule& rule : admission_rules) {
    const Finding& finding = d.*(rule.finding);
    if (!finding || (rule.decision != nullptr && policy.*(rule.decision) == Admission::accept)) continue;
    raise(make_problem(rule, finding));
  }
  if (d.empty())
    raise(SetupErrorKind::empty_mesh,
          std::to_string(d.node_count) + " nodes and " + std::to_string(d.element_count) + " elements are left");
}

/// Checks the ids in the groups that were copied.
inline void require_valid_groups(const MeshRef& mesh) {
  const auto outside = [](Index id, Index count) { return id < 0 || id >= count; };
  for (const Group& g : mesh.groups) {
    bool fine = std::ranges::none_of(g.nodes, [&](NodeId i) { return outside(i, mesh.node_count); }) &&
                std::ranges::none_of(g.elements, [&](Index e) { return outside(e, mesh.element_count); });
    for (const auto& face : g.faces)
      fine = fine && mesh.element.is_face_size(face.size()) &&
             std::ranges::none_of(face, [&](NodeId i) { return outside(i, mesh.node_count); });
    if (!fine)
      raise(SetupErrorKind::index_out_of_range, "group '" + g.name +
                                                    "' names a node or element that does not exist, or a face of " +
                                                    "another kind of element");
  }
}

inline void apply_node_map(MeshToAdmit& work, const std::vector<NodeId>& map) {
  renumber_nodes(work.mesh, map);
  for (NodeId& i : work.node_map)
    if (i >= 0) i = map[static_cast<std::size_t>(i)];
}

/// Welds coincident nodes. Returns whether there were any.
inline bool weld(MeshToAdmit& work, const MeshThresholds& thresholds) {
  const CoincidentNodes coincident = coincident_nodes(work.mesh.ref(), thresholds.coincidence);
  std::vector<NodeId> map(coincident.representative.size());
  NodeId next = 0;
  for (std::size_t i = 0; i < map.size(); ++i) {
    const auto representative = static_cast<std::size_t>(coincident.representative[i]);  // never above i
    map[i] = representative == i ? next++ : map[representative];
  }
  if (static_cast<std::size_t>(next) == map.size()) return false;
  apply_node_map(work, map);
  return true;
}

/// -1 inverted, 0 flat, 1 sound.
inline int orientation_of(const MeshToAdmit& work, Index e, const MeshThresholds& thresholds) noexcept {
  return orientation(work.shape_of(flat(work.mesh.positions), work.mesh.nodes_of(e)), thresholds);
}

/// `map`: the new number of every element, -1 for those to drop.
inline void apply_element_map(MeshToAdmit& work, const std::vector<Index>& map) {
  renumber_elements(work.mesh, map);
  for (Index& e : work.element_map)
    if (e >= 0) e = map[static_cast<std::size_t>(e)];
}

/// Drops flat and repeated elements if the policy requires it. Returns whether there were any.
inline bool drop_elements(MeshToAdmit& work, const AdmissionPolicy& policy) {
  if (policy.duplicate_elements != Admission::repair && policy.degenerate != Admission::repair) return false;
  const std::vector<Index> first = first_equal_elements(work.mesh.ref());
  std::vector<Index> map(first.size());
  Index next = 0;
  for (Index e = 0; e < work.mesh.element_count; ++e) {
    const bool repeated = policy.duplicate_elements == Admission::repair && first[static_cast<std::size_t>(e)] != e;
    const bool flat = policy.degenerate == Admission::repair && orientation_of(work, e, policy.thresholds) == 0;
    map[static_cast<std::size_t>(e)] = repeated || flat ? -1 : next++;
  }
  if (next == work.mesh.element_count) return false;
  apply_element_map(work, map);
  return true;
}

/// Drops the elements of all pieces but the one of most elements. Returns whether there were any.
inline bool keep_largest_piece(MeshToAdmit& work) {
  const MeshComponents components = connected_components(work.mesh.ref());
  if (components.count < 2) return false;
  const auto piece_of = [&](Index e) {
    return static_cast<std::size_t>(components.of_node[static_cast<std::size_t>(*work.mesh.nodes_of(e))]);
  };
  std::vector<Index> size(static_cast<std::size_t>(components.count), 0);
  for (Index e = 0; e < work.mesh.element_count; ++e) ++size[piece_of(e)];
  const auto largest = static_cast<std::size_t>(std::ranges::max_element(size) - size.begin());
  std::vector<Index> map(static_cast<std::size_t>(work.mesh.element_count), -1);
  Index next = 0;
  for (Index e = 0; e < work.mesh.element_count; ++e)
    if (piece_of(e) == largest) map[static_cast<std::size_t>(e)] = next++;
  apply_element_map(work, map);
  return true;
}

/// Reverses the orientation of inverted elements. Returns whether there were any.
inline bool reverse_inverted(MeshToAdmit& work, const MeshThresholds& thresholds) {
  std::vector<Index> inverted;
  for (Index e = 0; e < work.mesh.element_count; ++e)
    if (orientation_of(work, e, thresholds) < 0) inverted.push_back(e);
  if (!inverted.empty()) reorient(work.mesh, inverted);
  return !inverted.empty();
}

/// Drops nodes that no element uses, also those left over by other repairs. Returns whether there were any.
inline bool drop_orphans(MeshToAdmit& work) {
  const std::vector<char> used = used_nodes(work.mesh.ref());
  std::vector<NodeId> map(used.size(), -1);
  NodeId next = 0;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] != 0) map[i] = next++;
  if (static_cast<std::size_t>(next) == used.size()) return false;
  apply_node_map(work, map);
  return true;
}

/// Makes all repairs that the policy allows, ordered so that each also handles the results of the previous ones.
/// Returns whether anything was changed.
inline bool repair(MeshToAdmit& work, const AdmissionPolicy& policy) {
  bool changed = false;
  if (policy.duplicate_nodes == Admission::repair) changed = weld(work, policy.thresholds) || changed;
  changed = drop_elements(work, policy) || changed;
  if (policy.disconnected == Admission::repair) changed = keep_largest_piece(work) || changed;
  if (policy.inverted == Admission::repair) changed = reverse_inverted(work, policy.thresholds) || changed;
  if (policy.orphans == Admission::repair) changed = drop_orphans(work) || changed;
  return changed;
}

PALPATE_INLINE void repair_and_enforce(MeshToAdmit& candidate, const AdmissionPolicy& policy) {
  require_valid_groups(candidate.mesh.ref());
  candidate.node_map.resize(candidate.mesh.positions.size());
  candidate.element_map.resize(static_cast<std::size_t>(candidate.mesh.element_count));
  std::iota(candidate.node_map.begin(), candidate.node_map.end(), NodeId{0});
  std::iota(candidate.element_map.begin(), candidate.element_map.end(), Index{0});
  if (repair(candidate, policy)) {
    const MeshRef mesh = candidate.mesh.ref();
    candidate.admitted = begin_diagnosis(mesh.node_count, mesh.element_count);
    check_indices(mesh, candidate.admitted);
    diagnose_rest(mesh, candidate.shape_of, policy.thresholds, candidate.admitted);
  }
  const OriginalIds ids = original_ids(candidate.node_map, candidate.element_map);
  const ScopedIdTranslation translation(ids);
  enforce(candidate.admitted, policy);
}

PALPATE_INLINE OriginalIds original_ids(const std::vector<NodeId>& node_map, const std::vector<Index>& element_map) {
  return {inverse_of(node_map), inverse_of(element_map)};
}

}}}  // namespace palpate::detail
