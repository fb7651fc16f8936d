// The entity, node and element sections of Gmsh's format 4.1.
#pragma once

#include <palpate/io/detail/gmsh_state.hpp>
#include <palpate/io/detail/id_table.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh::msh4 {

/// $Entities: numbers of points, curves, surfaces and volumes, then the entities.
void read_entities(TextReader& in, State& state);

/// $Nodes.
void read_nodes(TextReader& in, State& state);

/// $Elements.
void read_elements(TextReader& in, State& state);

namespace detail {

/// An entity: `tag box nphys phys... [nbound bound...]`; the box has 3 numbers for a point and 6 for the others. Gmsh
/// writes boxes that overflow for empty entities, so they are ignored. Elements belong to groups only through their
/// entity.
PALPATE_COLD inline void read_entity(const Numbers& in, int dimension, State& state) {
  in.begin("an entity");
  const Index tag = in.integer("an entity tag", -max_int, max_int);
  in.skip_reals(dimension == 0 ? 3 : 6, "a bounding box");
  std::vector<int> physical;
  const Index count = in.long_integer("a number of physical tags", 0, max_int, SetupErrorKind::count_too_large);
  for (Index i = 0; i < count; ++i)
    if (const int group = read_physical(in); group != 0) physical.push_back(group);
  if (dimension > 0) {
    const Index bounds = in.long_integer("a number of bounding entities", 0, max_int, SetupErrorKind::count_too_large);
    for (Index i = 0; i < bounds; ++i) in.integer("a bounding entity", -max_int, max_int);
  }
  in.end("an entity");
  sort_unique(physical);
  const std::uint32_t set = state.sets.find_or_add(state.mesh, physical);
  if (!state.entities.try_emplace(std::pair<Index, Index>(dimension, tag), set).second)
    in.in.refuse(SetupErrorKind::bad_file, "every entity once",
                 {"entity ", tag, " of dimension ", dimension, " twice"});
}

/// The numbers in the first record of $Nodes and $Elements: `blocks things min max`.
struct SectionHeader {
  Index blocks, things;
};

PALPATE_COLD inline SectionHeader read_header(const Numbers& in, std::string_view what, Index text_bytes,
                                              Index binary_bytes) {
  in.begin(what);
  const Index blocks = in.count("a number of blocks", 8, 20);
  const Index things = in.count(what, text_bytes, binary_bytes);
  for (int i = 0; i < 2; ++i) in.long_integer("the smallest and largest tag", 0, max_tag);
  in.end(what);
  return {blocks, things};
}

/// Refuses blocks whose total differs from the count in the header of the section.
PALPATE_COLD inline void check_total(const TextReader& in, std::string_view what, Index expected, std::size_t found) {
  if (static_cast<Index>(found) != expected)
    in.refuse(SetupErrorKind::bad_file, {expected, " ", what}, {found, " in the blocks"});
}

/// A block of nodes: `dimension entity parametric count`, then `count` ids, then `count` positions each followed by
/// `dimension` parameters if parametric. In text the ids may be on any number of lines.
inline void read_node_block(const Numbers& in, FileMesh& mesh) {
  in.begin("a block of nodes");
  const Index dimension = in.integer("a dimension", 0, 3);
  in.integer("an entity tag", -max_int, max_int);
  const Index parameters = in.integer("0 or 1 for parametric", 0, 1) * dimension;
  const Index count = in.count("a number of nodes", 8, 32);
  in.end("a block of nodes");
  for (Index i = 0; i < count; ++i) {
    in.begin_anywhere("a node id");
    mesh.node_tags.push_back(in.long_integer("a node id", 1, max_tag));
  }
  in.end("the node ids");
  for (Index i = 0; i < count; ++i) {
    in.begin("a position");
    mesh.positions.push_back(in.point());
    for (Index p = 0; p < parameters; ++p) in.real("a parameter");
    in.end("a position");
  }
}

/// The physical tags of an entity. Without $Entities there are none; an entity missing from $Entities is refused.
PALPATE_COLD inline std::uint32_t physical_set(const TextReader& in, const State& state, int dimension, Index tag) {
  if (state.entities.empty()) return 0;
  const auto it = state.entities.find(std::pair<Index, Index>(dimension, tag));
  if (it == state.entities.end())
    in.refuse(SetupErrorKind::index_out_of_range, "an entity of $Entities",
              {"entity ", tag, " of dimension ", dimension});
  return it->second;
}

/// The tags of the elements of an entity that are used.
PALPATE_COLD inline std::uint32_t used_set(const TextReader& in, State& state, int dimension, Index tag, Index count) {
  const std::uint32_t physical = physical_set(in, state, dimension, tag);
  if (dimension == 3 && count > 0) {
    state.has_physical = state.has_physical || physical != 0;
    for (int i = 0; i < 2; ++i)
      state.elementary.add(static_cast<double>(tag));  // one entity is a label, also a small one
  }
  return state.by_elementary ? state.sets.find_or_add(state.mesh, static_cast<int>(tag)) : physical;
}

/// Adds `count` elements to the count of group memberships. A few bytes can put every element into thousands of groups;
/// the memory for that must stay proportional to the size of the file.
inline void add_memberships(const TextReader& in, State& state, std::uint32_t set, Index count) {
  const auto limit = static_cast<Index>(in.size());
  state.memberships += count * static_cast<Index>(state.mesh.tag_sets[set].size());
  if (state.memberships > limit)
    in.refuse(SetupErrorKind::count_too_large, {"elements in groups at most ", limit, " times"}, {state.memberships});
}

/// A block of elements: `dimension entity type count`, then `id nodes...` each.
inline void read_element_block(const Numbers& in, const NodeIds& nodes, State& state) {
  in.begin("a block of elements");
  const auto dimension = static_cast<int>(in.integer("a dimension", 0, 3));
  const Index entity = in.integer("an entity tag", -max_int, max_int);
  const Type& type = read_type(in);
  const Index count = in.count("a number of elements", 4, 16);
  in.end("a block of elements");
  const ShapeFacts& shape = facts(type.shape);
  if (shape.dimension != dimension)
    in.in.refuse(SetupErrorKind::bad_file, {"elements of dimension ", dimension}, shape.name);
  const std::uint32_t set = used_set(in.in, state, dimension, entity, count);
  add_memberships(in.in, state, set, count);
  for (Index i = 0; i < count; ++i) {
    in.begin("an element");
    const Index place = in.in.location(), tag = in.long_integer("an element id", 1, max_tag);
    for (int a = 0; a < shape.nodes; ++a)
      state.mesh.cell_nodes.push_back(nodes.find(in.long_integer("a node id", 1, nodes.last()), in.in));
    state.mesh.add_cell(tag, place, type.shape, set, type.order);
    in.end("an element");
  }
}

}  // namespace detail

PALPATE_COLD inline void read_entities(TextReader& in, State& state) {
  const Numbers numbers(in, state.format.is_binary, state.format.swap);
  numbers.begin("the numbers of entities");
  std::array<Index, 4> counts{};
  for (std::size_t d = 0; d < 4; ++d)
    counts[d] = numbers.count("a number of entities", d == 0 ? 10 : 18, d == 0 ? 36 : 68);
  numbers.end("the numbers of entities");
  for (int d = 0; d < 4; ++d)
    for (Index i = 0; i < counts[static_cast<std::size_t>(d)]; ++i) detail::read_entity(numbers, d, state);
}

inline void read_nodes(TextReader& in, State& state) {
  const Numbers numbers(in, state.format.is_binary, state.format.swap);
  const detail::SectionHeader header = detail::read_header(numbers, "a number of nodes", 8, 32);
  state.mesh.positions.reserve(static_cast<std::size_t>(header.things));
  state.mesh.node_tags.reserve(static_cast<std::size_t>(header.things));
  for (Index b = 0; b < header.blocks; ++b) detail::read_node_block(numbers, state.mesh);
  detail::check_total(in, "nodes", header.things, state.mesh.node_tags.size());
}

inline void read_elements(TextReader& in, State& state) {
  const NodeIds nodes(state.mesh.node_tags, in);
  const Numbers numbers(in, state.format.is_binary, state.format.swap);
  const detail::SectionHeader header = detail::read_header(numbers, "a number of elements", 4, 16);
  state.mesh.cells.reserve(static_cast<std::size_t>(header.things));
  for (Index b = 0; b < header.blocks; ++b) detail::read_element_block(numbers, nodes, state);
  detail::check_total(in, "elements", header.things, state.mesh.cells.size());
}

}}}  // namespace palpate::PALPATE_ABI::io::gmsh::msh4
