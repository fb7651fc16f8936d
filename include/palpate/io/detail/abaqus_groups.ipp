// Definitions of abaqus_groups.hpp.
#pragma once

#include <palpate/io/detail/abaqus_groups.hpp>
#include <palpate/io/detail/abaqus_lines.hpp>
#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/tag_sets.hpp>

#include <algorithm>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

PALPATE_COLD PALPATE_INLINE void Sets::open(const std::string& name, bool of_assembly, bool is_internal) {
  const auto [known, is_new] =
      by_name_.try_emplace(std::pair(of_assembly, upper(name)), static_cast<Index>(sets_.size()));
  if (is_new) sets_.push_back({name, of_assembly, is_internal, {}});
  definitions_.push_back({static_cast<std::size_t>(known->second), items_.size()});
}

PALPATE_INLINE void Sets::add_ids(Index first, Index last, Index step, Index line) {
  const auto number = [](Index i) { return static_cast<int>(std::min<Index>(i, std::numeric_limits<int>::max())); };
  items_.push_back({number(first), number(last), number(step), number(line)});
}

PALPATE_COLD PALPATE_INLINE void Sets::add_positions(std::size_t first, std::size_t last) {
  items_.push_back({static_cast<int>(first), static_cast<int>(last), 0, 0});
}

PALPATE_COLD PALPATE_INLINE void Sets::add_set(Index set) {
  items_.push_back({static_cast<int>(set), 0, -1, 0});
}

PALPATE_COLD PALPATE_INLINE void Sets::add_nodes_of(Index element_set) {
  items_.push_back({static_cast<int>(element_set), 0, -2, 0});
}

PALPATE_COLD PALPATE_INLINE Index Sets::find(std::string_view name, bool of_assembly) const {
  const std::string key = upper(name);
  auto found = by_name_.end();
  if (of_assembly) found = by_name_.find(std::pair(true, key));
  if (found == by_name_.end()) found = by_name_.find(std::pair(false, key));
  return found == by_name_.end() ? -1 : found->second;
}

PALPATE_INLINE void Sets::add(std::vector<int>& members, const Item& item, const IdTable& ids, const TextReader& in,
                              Index& memberships, const NodesOf& nodes_of) {
  const std::size_t before = members.size();
  if (item.step == -2) {
    nodes_of(item.first, members);
  } else if (item.step < 0) {
    const std::vector<int> other = sets_[static_cast<std::size_t>(item.first)].members;
    check_memberships(in, memberships + static_cast<Index>(other.size()));
    members.insert(members.end(), other.begin(), other.end());
  } else if (item.step == 0) {
    for (int i = item.first; i < item.last; ++i) members.push_back(i);
  } else {
    for (const Ranked& r : ids.from(item.first)) {
      if (r.key > item.last) break;
      if ((r.key - item.first) % item.step == 0)
        members.push_back(static_cast<int>(r.id));
      else
        check_memberships(in, ++memberships);  // so that also the time is proportional to the size of the file
    }
    if (members.size() == before)
      refuse_at(in, item.line, SetupErrorKind::index_out_of_range, {"the id of a ", ids.what, " of this file"},
                {"'", item.first, "'"});
  }
  memberships += static_cast<Index>(members.size() - before);
  check_memberships(in, memberships);
}

PALPATE_INLINE void Sets::resolve(const IdTable& ids, const TextReader& in, Index& memberships,
                                  const NodesOf& nodes_of) {
  for (std::size_t d = 0; d < definitions_.size(); ++d) {
    std::vector<int>& members = sets_[definitions_[d].set].members;
    const std::size_t end = d + 1 < definitions_.size() ? definitions_[d + 1].first_item : items_.size();
    for (std::size_t i = definitions_[d].first_item; i < end; ++i)
      add(members, items_[i], ids, in, memberships, nodes_of);
  }
  for (Set& set : sets_) sort_unique(set.members);
}

PALPATE_COLD PALPATE_INLINE void check_memberships(const TextReader& in, Index memberships) {
  const auto limit = static_cast<Index>(in.size());
  if (memberships > limit)
    in.refuse(SetupErrorKind::count_too_large, {"nodes, elements and faces in sets at most ", limit, " times"},
              {memberships});
}

namespace detail {

/// Adds groups to a mesh: tags of elements first, then new cells for faces and nodes.
class GroupBuilder {
 public:
  GroupBuilder(Groups& groups, std::span<const Index> cells, const TextReader& in, FileMesh& mesh)
      : groups_(groups), cells_(cells), in_(in), mesh_(mesh) {}

  void build(const IdTable& nodes, const IdTable& elements);

 private:
  void add_nodes_of(Index element_set, std::vector<int>& nodes);
  void add_regions(std::vector<std::vector<int>>& tags);
  void add_element_sets();
  void add_node_sets();
  void add_surface(const Surface& surface, const IdTable& nodes, const IdTable& elements);
  void add_part(const SurfacePart& part, const IdTable& ids, const Sets& sets, std::uint32_t tag_set);
  void add_face(Index cell, const SurfacePart& part, std::uint32_t tag_set);
  void add_node(int node, std::uint32_t tag_set);
  void add_cell(CellShape shape, std::span<const NodeId> nodes, std::uint32_t tag_set);
  std::string group_name(const Sets& sets, const Sets::Set& set) const;
  int new_tag(int dimension, const std::string& name);

  Groups& groups_;
  std::span<const Index> cells_;
  const TextReader& in_;
  FileMesh& mesh_;
  TagSets known_;
  int last_tag_ = 0;
  Index memberships_ = 0;
};

inline void GroupBuilder::build(const IdTable& nodes, const IdTable& elements) {
  groups_.elements.resolve(elements, in_, memberships_);
  groups_.nodes.resolve(nodes, in_, memberships_, [&](Index set, std::vector<int>& out) { add_nodes_of(set, out); });
  add_element_sets();
  for (const Surface& surface : groups_.surfaces) add_surface(surface, nodes, elements);
  add_node_sets();
}

PALPATE_COLD inline void GroupBuilder::add_nodes_of(Index element_set, std::vector<int>& nodes) {
  for (const int e : groups_.elements.all()[static_cast<std::size_t>(element_set)].members) {
    const Index at = cells_[static_cast<std::size_t>(e)];
    check_memberships(in_, ++memberships_);  // so that also the time is proportional to the size of the file
    if (at < 0) continue;
    const FileCell& cell = mesh_.cells[static_cast<std::size_t>(at)];
    for (std::size_t a = 0; a < static_cast<std::size_t>(facts(cell.shape).nodes); ++a)
      nodes.push_back(mesh_.cell_nodes[cell.first_node + a]);
  }
}

/// Names of the part that the assembly also uses get a prefix.
PALPATE_COLD inline std::string GroupBuilder::group_name(const Sets& sets, const Sets::Set& set) const {
  const Index of_assembly = set.of_assembly ? -1 : sets.find(set.name, true);
  const bool is_twice = of_assembly >= 0 && sets.all()[static_cast<std::size_t>(of_assembly)].of_assembly;
  return is_twice ? joined({"part.", set.name}) : set.name;
}

PALPATE_COLD inline int GroupBuilder::new_tag(int dimension, const std::string& name) {
  mesh_.names.push_back({dimension, ++last_tag_, name});
  return last_tag_;
}

inline void GroupBuilder::add_regions(std::vector<std::vector<int>>& tags) {
  std::vector<Index> regions = groups_.sections.empty() ? groups_.element_blocks : groups_.sections;
  std::vector<char> is_known(groups_.elements.all().size());
  for (const Index r : regions) {
    const auto at = static_cast<std::size_t>(r);
    if (std::exchange(is_known[at], char{1}) != 0) continue;
    const Sets::Set& set = groups_.elements.all()[at];
    const int tag = new_tag(3, group_name(groups_.elements, set));
    for (const int e : set.members)
      if (const Index cell = cells_[static_cast<std::size_t>(e)];
          cell >= 0 && tags[static_cast<std::size_t>(cell)].empty() &&
          facts(mesh_.cells[static_cast<std::size_t>(cell)].shape).dimension == 3)
        tags[static_cast<std::size_t>(cell)].push_back(tag);
  }
  mesh_.last_region = last_tag_;
}

/// A set with elements of several dimensions has one tag for all.
inline void GroupBuilder::add_element_sets() {
  std::vector<std::vector<int>> tags(mesh_.cells.size());
  add_regions(tags);
  for (const Sets::Set& set : groups_.elements.all()) {
    if (set.is_internal) continue;
    const int tag = ++last_tag_;
    std::array<bool, 4> has_dimension{false, false, false, set.members.empty()};
    for (const int e : set.members) {
      const Index cell = cells_[static_cast<std::size_t>(e)];
      if (cell < 0) continue;
      tags[static_cast<std::size_t>(cell)].push_back(tag);
      const CellShape shape = mesh_.cells[static_cast<std::size_t>(cell)].shape;
      has_dimension[static_cast<std::size_t>(facts(shape).dimension)] = true;
    }
    const std::string name = group_name(groups_.elements, set);
    for (int d = 1; d < 4; ++d)
      if (has_dimension[static_cast<std::size_t>(d)]) mesh_.names.push_back({d, tag, name});
  }
  for (std::size_t c = 0; c < tags.size(); ++c) mesh_.cells[c].tag_set = known_.find_or_add(mesh_, tags[c]);
}

inline void GroupBuilder::add_node_sets() {
  for (const Sets::Set& set : groups_.nodes.all()) {
    if (set.is_internal) continue;
    const std::uint32_t tag_set = known_.find_or_add(mesh_, new_tag(0, group_name(groups_.nodes, set)));
    for (const int node : set.members) add_node(node, tag_set);
  }
}

inline void GroupBuilder::add_surface(const Surface& surface, const IdTable& nodes, const IdTable& elements) {
  const bool is_of_nodes = !surface.parts.empty() && surface.parts.front().face == SurfacePart::of_nodes;
  const std::uint32_t tag_set = known_.find_or_add(mesh_, new_tag(is_of_nodes ? 0 : 2, surface.name));
  for (const SurfacePart& part : surface.parts)
    is_of_nodes ? add_part(part, nodes, groups_.nodes, tag_set) : add_part(part, elements, groups_.elements, tag_set);
}

inline void GroupBuilder::add_part(const SurfacePart& part, const IdTable& ids, const Sets& sets,
                                   std::uint32_t tag_set) {
  const auto add = [&](Index i) {
    if (part.face == SurfacePart::of_nodes)
      add_node(static_cast<int>(i), tag_set);
    else if (const Index cell = cells_[static_cast<std::size_t>(i)]; cell >= 0)
      add_face(cell, part, tag_set);
  };
  if (part.id < 0) {
    const std::vector<int>& members = sets.all()[static_cast<std::size_t>(part.set)].members;
    check_memberships(in_, memberships_ += static_cast<Index>(members.size()));
    for (const int i : members) add(i);
    return;
  }
  const Index found = ids.find(part.id);
  if (found < 0)
    refuse_at(in_, part.line, SetupErrorKind::index_out_of_range, {"the id of a ", ids.what, " of this file"},
              {"'", part.id, "'"});
  check_memberships(in_, ++memberships_);
  add(found);
}

/// Corners of the face, then the middles of its edges in the order of VTK.
inline void GroupBuilder::add_face(Index cell, const SurfacePart& part, std::uint32_t tag_set) {
  const FileCell solid = mesh_.cells[static_cast<std::size_t>(cell)];
  const ShapeFacts& shape = facts(solid.shape);
  const std::vector<NodeId> nodes(
      mesh_.cell_nodes.begin() + static_cast<std::ptrdiff_t>(solid.first_node),
      mesh_.cell_nodes.begin() + static_cast<std::ptrdiff_t>(solid.first_node) + shape.nodes);
  if (shape.dimension < 3) {
    if (shape.dimension == 2) add_cell(solid.shape, nodes, tag_set);
    return;
  }
  const bool is_tetrahedron = solid.shape == CellShape::tetrahedron4 || solid.shape == CellShape::tetrahedron10;
  const bool is_hexahedron = solid.shape == CellShape::hexahedron8 || solid.shape == CellShape::hexahedron20;
  if (!is_tetrahedron && !is_hexahedron) return;  // refused by the builder of the mesh
  const int count = is_tetrahedron ? 4 : 6;
  if (part.face < 0)
    refuse_at(in_, part.line, SetupErrorKind::unsupported, "a face S1 to S6 of solid elements", "none",
              "Write the surface with the faces of its elements");
  if (part.face >= count)
    refuse_at(in_, part.line, SetupErrorKind::index_out_of_range, {"a face S1 to S", count, " of a ", shape.name},
              {"S", part.face + 1});
  const auto at = static_cast<std::size_t>(part.face);
  const std::span<const int> corners =
      is_tetrahedron ? std::span<const int>(tetrahedron_faces[at]) : std::span<const int>(hexahedron_faces[at]);
  std::vector<NodeId> face;
  for (const int c : corners) face.push_back(nodes[static_cast<std::size_t>(c)]);
  const std::span<const std::array<int, 2>> edges = is_tetrahedron
                                                        ? std::span<const std::array<int, 2>>(tetrahedron_edges)
                                                        : std::span<const std::array<int, 2>>(hexahedron_edges);
  const std::size_t first_middle = is_tetrahedron ? 4 : 8;
  for (std::size_t a = 0; nodes.size() > first_middle && a < corners.size(); ++a) {
    const int from = corners[a], to = corners[(a + 1) % corners.size()];
    for (std::size_t e = 0; e < edges.size(); ++e)
      if (edges[e][0] == std::min(from, to) && edges[e][1] == std::max(from, to))
        face.push_back(nodes[first_middle + e]);
  }
  add_cell(face_shape(solid.shape), face, tag_set);
}

inline void GroupBuilder::add_node(int node, std::uint32_t tag_set) {
  const NodeId id = node;
  add_cell(CellShape::point, std::span<const NodeId>(&id, 1), tag_set);
}

inline void GroupBuilder::add_cell(CellShape shape, std::span<const NodeId> nodes, std::uint32_t tag_set) {
  mesh_.cell_nodes.insert(mesh_.cell_nodes.end(), nodes.begin(), nodes.end());
  mesh_.add_cell(0, 1, shape, tag_set, {});
}

}  // namespace detail

PALPATE_INLINE void add_groups(Groups& groups, const IdTable& nodes, const IdTable& elements,
                               std::span<const Index> cells, const TextReader& in, FileMesh& mesh) {
  detail::GroupBuilder(groups, cells, in, mesh).build(nodes, elements);
}

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
