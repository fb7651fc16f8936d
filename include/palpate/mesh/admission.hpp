// The door of the library: a mesh is refused, repaired or let in, and what was found is reported.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/admission_policy.hpp>
#include <palpate/mesh/diagnose.hpp>
#include <palpate/mesh/diagnosis.hpp>
#include <palpate/mesh/duplicates.hpp>
#include <palpate/mesh/fibres.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/repair.hpp>

#include <algorithm>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A mesh that passed. Maps lead from the mesh as given to this one; -1 means dropped, welded nodes share an id.
template <Element E>
struct Admitted {
  Mesh<E> mesh;
  std::vector<NodeId> node_map;
  std::vector<Index> element_map;
  MeshDiagnosis diagnosis;  ///< of the mesh as given, in its ids
  MeshDiagnosis admitted;   ///< of `mesh`; the same when nothing was repaired
};

namespace detail {

/// Ids of the mesh as given for those of the repaired one.
template <class Id>
void restore_ids(std::vector<std::int64_t>& ids, const std::vector<Id>& map) {
  if (map.empty()) return;  // nothing was repaired yet
  std::vector<std::int64_t> origin;
  for (std::size_t i = map.size(); i-- > 0;) {  // backwards: the lowest of several welded nodes wins
    if (map[i] < 0) continue;
    const auto to = static_cast<std::size_t>(map[i]);
    if (to >= origin.size()) origin.resize(to + 1, -1);
    origin[to] = static_cast<std::int64_t>(i);
  }
  for (auto& id : ids) id = origin[static_cast<std::size_t>(id)];
}

/// Refuses what the policy does not accept. `admitted.admitted` is what is left after the repairs.
template <Element E>
void enforce(const Admitted<E>& admitted, const AdmissionPolicy& policy) {
  const MeshDiagnosis& d = admitted.admitted;
  for (const AdmissionRule& rule : admission_rules) {
    const Finding& finding = d.*(rule.finding);
    if (!finding || (rule.decision != nullptr && policy.*(rule.decision) == Admission::accept)) continue;
    SetupProblem p = make_problem(rule, finding);
    if (rule.of_nodes)
      restore_ids(p.ids, admitted.node_map);
    else
      restore_ids(p.ids, admitted.element_map);
    raise(std::move(p));
  }
  if (d.empty())
    raise(SetupErrorKind::empty_mesh, std::to_string(d.node_count) + " nodes and " + std::to_string(d.element_count) +
                                          " elements are left to compute with");
}

/// Ids of the groups that were copied.
template <Element E>
void require_valid_groups(const Mesh<E>& mesh) {
  for (const Group& g : mesh.groups.all()) {
    const auto outside = [](Index id, Index count) { return id < 0 || id >= count; };
    bool fine = std::ranges::none_of(g.nodes, [&](NodeId i) { return outside(i, mesh.node_count()); }) &&
                std::ranges::none_of(g.elements, [&](Index e) { return outside(e, mesh.element_count()); });
    for (const auto& face : g.faces)
      fine = fine && is_face_size<E>(face.size()) &&
             std::ranges::none_of(face, [&](NodeId i) { return outside(i, mesh.node_count()); });
    if (!fine)
      raise(SetupErrorKind::index_out_of_range, "group '" + g.name +
                                                    "' names a node or element that does not exist, or a face of " +
                                                    "another kind of element");
  }
}

template <Element E>
void apply_node_map(Admitted<E>& work, const std::vector<NodeId>& map) {
  renumber_nodes(work.mesh, map);
  for (NodeId& i : work.node_map)
    if (i >= 0) i = map[static_cast<std::size_t>(i)];
}

/// Welds coincident nodes. Returns whether there were any.
template <Element E>
bool weld(Admitted<E>& work, const MeshThresholds& thresholds) {
  const auto coincident = coincident_nodes<E>(work.mesh, thresholds.coincidence);
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

/// Drops flat and repeated elements, as the policy says. Returns whether there were any.
template <Element E>
bool drop_elements(Admitted<E>& work, const AdmissionPolicy& policy) {
  if (policy.duplicate_elements != Admission::repair && policy.degenerate != Admission::repair) return false;
  const std::vector<Index> first = first_equal_elements<E>(work.mesh);
  std::vector<Index> map(first.size());
  Index next = 0;
  for (Index e = 0; e < work.mesh.element_count(); ++e) {
    const bool repeated = policy.duplicate_elements == Admission::repair && first[static_cast<std::size_t>(e)] != e;
    const bool flat = policy.degenerate == Admission::repair &&
                      orientation(element_shape<E>(element_nodes<E>(work.mesh, e)), policy.thresholds) == 0;
    map[static_cast<std::size_t>(e)] = repeated || flat ? -1 : next++;
  }
  if (next == work.mesh.element_count()) return false;
  renumber_elements(work.mesh, map);
  for (Index& e : work.element_map) e = map[static_cast<std::size_t>(e)];
  return true;
}

/// Turns inverted elements round. Returns whether there were any.
template <Element E>
bool turn_round(Mesh<E>& mesh, const MeshThresholds& thresholds) {
  std::vector<Index> inverted;
  for (Index e = 0; e < mesh.element_count(); ++e)
    if (orientation(element_shape<E>(element_nodes<E>(mesh, e)), thresholds) < 0) inverted.push_back(e);
  if (!inverted.empty()) reorient(mesh, inverted);
  return !inverted.empty();
}

/// Drops nodes that no element uses (any more). Returns whether there were any.
template <Element E>
bool drop_orphans(Admitted<E>& work) {
  const std::vector<char> used = used_nodes<E>(work.mesh);
  std::vector<NodeId> map(used.size(), -1);
  NodeId next = 0;
  for (std::size_t i = 0; i < used.size(); ++i)
    if (used[i] != 0) map[i] = next++;
  if (static_cast<std::size_t>(next) == used.size()) return false;
  apply_node_map(work, map);
  return true;
}

/// All repairs the policy allows, in the order in which one may make work for the next. Returns whether anything was
/// changed.
template <Element E>
bool repair(Admitted<E>& work, const AdmissionPolicy& policy) {
  bool changed = false;
  if (policy.duplicate_nodes == Admission::repair) changed = weld(work, policy.thresholds) || changed;
  changed = drop_elements(work, policy) || changed;
  if (policy.inverted == Admission::repair) changed = turn_round(work.mesh, policy.thresholds) || changed;
  if (policy.orphans == Admission::repair) changed = drop_orphans(work) || changed;
  return changed;
}

}  // namespace detail

/// An owning, sound copy of any mesh, or SetupError (kind, first ids of the mesh as given, count, worst value, bound,
/// hint). Nothing is repaired, accepted or dropped without being in `diagnosis`. Of a view only the groups in
/// `group_names` can be copied, as views do not list theirs; names it does not have are skipped. An owning mesh keeps
/// all its groups when none is named. Groups follow the repairs; their faces lose those that fell together or lost a
/// node. O(n log n); the mesh is diagnosed again if it was repaired.
template <Element E, MeshOf<E> M>
Admitted<E> admit(const M& view, const AdmissionPolicy& policy = {}, const std::vector<std::string>& group_names = {}) {
  detail::require_usable(policy);
  Admitted<E> result;
  result.diagnosis = diagnose<E>(view, policy.thresholds);
  result.admitted = result.diagnosis;
  if (!result.diagnosis.complete) detail::enforce(result, policy);  // refuses
  require_unit_fibres(view);
  result.mesh = copy_mesh<E>(view, group_names);
  detail::require_valid_groups(result.mesh);
  result.node_map.resize(result.mesh.positions.size());
  result.element_map.resize(result.mesh.elements.size());
  std::iota(result.node_map.begin(), result.node_map.end(), NodeId{0});
  std::iota(result.element_map.begin(), result.element_map.end(), Index{0});
  if (detail::repair(result, policy)) result.admitted = diagnose<E>(result.mesh, policy.thresholds);
  detail::enforce(result, policy);
  return result;
}

}}  // namespace palpate
