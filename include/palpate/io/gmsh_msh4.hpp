// The entity, node and element sections of Gmsh's format 4.1, ASCII.
#pragma once

#include <palpate/io/gmsh_data.hpp>

#include <map>

namespace palpate::inline PALPATE_ABI::io::gmsh::msh4 {

/// Physical tags of the geometric entities: (dimension, entity tag) -> entry of Data::physical_sets. Elements belong to
/// groups only by way of their entity.
using Entities = std::map<std::pair<int, Index>, std::size_t>;

/// A line of $Entities: `tag box nphys phys... [nbound bound...]`; the box has 3 numbers for a point and 6 for the
/// others. Gmsh writes boxes that overflow for empty entities, so they are not looked at.
inline void read_entity(TextReader& in, int dimension, Entities& entities, Data& data) {
  in.need_line("an entity");
  const Index tag = in.integer("an entity tag", -max_int, max_int);
  for (int i = 0; i < (dimension == 0 ? 3 : 6); ++i)
    if (in.token().empty()) in.refuse(SetupErrorKind::bad_file, "a bounding box", TextReader::quoted({}));
  std::vector<int> physical;
  const Index count = in.integer("a number of physical tags", 0, max_int, SetupErrorKind::count_too_large);
  for (Index i = 0; i < count; ++i)
    if (const int group = read_physical(in); group != 0) physical.push_back(group);
  if (dimension > 0) {
    const Index bounds = in.integer("a number of bounding entities", 0, max_int, SetupErrorKind::count_too_large);
    for (Index i = 0; i < bounds; ++i) in.integer("a bounding entity", -max_int, max_int);
  }
  in.end_line("an entity");
  const std::size_t set = physical.empty() ? 0 : data.physical_sets.size();
  if (!physical.empty()) data.physical_sets.push_back(std::move(physical));
  if (!entities.emplace(std::pair{dimension, tag}, set).second)
    in.refuse(SetupErrorKind::bad_file, "every entity once",
              "entity " + std::to_string(tag) + " of dimension " + std::to_string(dimension) + " twice");
}

/// $Entities: numbers of points, curves, surfaces and volumes, then one line for each.
inline void read_entities(TextReader& in, Entities& entities, Data& data) {
  in.need_line("the numbers of entities");
  std::array<Index, 4> counts{};
  for (std::size_t d = 0; d < 4; ++d) counts[d] = in.count("a number of entities", d == 0 ? 10 : 18);
  in.end_line("the numbers of entities");
  for (int d = 0; d < 4; ++d)
    for (Index i = 0; i < counts[static_cast<std::size_t>(d)]; ++i) read_entity(in, d, entities, data);
  end_section(in, "Entities");
}

/// The first line of $Nodes and $Elements: `blocks things min max`. Returns blocks and things.
inline std::pair<Index, Index> read_header(TextReader& in, std::string_view what, Index bytes_each) {
  in.need_line(what);
  const Index blocks = in.count("a number of blocks", 8);
  const Index things = in.count(what, bytes_each);
  for (int i = 0; i < 2; ++i) in.integer("the smallest and largest tag", 0, max_tag);
  in.end_line(what);
  return {blocks, things};
}

/// Refuses blocks that together do not hold what the header of the section said.
inline void check_total(const TextReader& in, std::string_view what, Index expected, Index found) {
  if (found != expected)
    in.refuse(SetupErrorKind::bad_file, std::to_string(expected) + ' ' + std::string(what),
              std::to_string(found) + " in the blocks");
}

/// A block of nodes: `dimension entity parametric count`, then `count` ids, then `count` positions with `dimension`
/// parameters behind each if parametric.
inline void read_node_block(TextReader& in, Data& data) {
  in.need_line("a block of nodes");
  const Index dimension = in.integer("a dimension", 0, 3);
  in.integer("an entity tag", -max_int, max_int);
  const Index parameters = in.integer("0 or 1 for parametric", 0, 1) * dimension;
  const Index count = in.count("a number of nodes", 8);
  in.end_line("a block of nodes");
  for (Index i = 0; i < count; ++i) {
    in.need_line("a node id");
    data.node_tags.push_back(in.integer("a node id", 1, max_tag));
    in.end_line("a node id");
  }
  for (Index i = 0; i < count; ++i) {
    in.need_line("a position");
    data.positions.push_back(read_point(in));
    for (Index p = 0; p < parameters; ++p) in.real("a parameter");
    in.end_line("a position");
  }
}

/// $Nodes.
inline void read_nodes(TextReader& in, Data& data) {
  const auto [blocks, count] = read_header(in, "a number of nodes", 8);
  data.positions.reserve(static_cast<std::size_t>(count));
  data.node_tags.reserve(static_cast<std::size_t>(count));
  for (Index b = 0; b < blocks; ++b) read_node_block(in, data);
  check_total(in, "nodes", count, static_cast<Index>(data.node_tags.size()));
  end_section(in, "Nodes");
}

/// The physical tags of an entity. Without $Entities there are none; an entity missing from $Entities is refused.
inline std::size_t physical_set(const TextReader& in, const Entities& entities, int dimension, Index tag) {
  if (entities.empty()) return 0;
  const auto it = entities.find({dimension, tag});
  if (it == entities.end())
    in.refuse(SetupErrorKind::index_out_of_range, "an entity of $Entities",
              "entity " + std::to_string(tag) + " of dimension " + std::to_string(dimension));
  return it->second;
}

/// A block of elements: `dimension entity type count`, then `id nodes...` per line.
inline void read_element_block(TextReader& in, const NodeLookup& nodes, const Entities& entities, Data& data) {
  in.need_line("a block of elements");
  const auto dimension = static_cast<int>(in.integer("a dimension", 0, 3));
  const Index entity = in.integer("an entity tag", -max_int, max_int);
  const Type* type = read_type(in);
  const Index count = in.count("a number of elements", 4);
  in.end_line("a block of elements");
  if (type->dimension != dimension)
    in.refuse(SetupErrorKind::bad_file, "elements of dimension " + std::to_string(dimension), type->name);
  const std::size_t set = physical_set(in, entities, dimension, entity);
  for (Index i = 0; i < count; ++i) {
    in.need_line("an element");
    const Index tag = in.integer("an element id", 1, max_tag);
    data.rows.push_back({tag, in.line_number(), data.row_nodes.size(), type, set});
    for (int a = 0; a < type->nodes; ++a) data.row_nodes.push_back(nodes.read(in));
    in.end_line("an element");
  }
}

/// $Elements.
inline void read_elements(TextReader& in, const Entities& entities, Data& data) {
  const NodeLookup nodes(data.node_tags, in);
  const auto [blocks, count] = read_header(in, "a number of elements", 4);
  data.rows.reserve(static_cast<std::size_t>(count));
  for (Index b = 0; b < blocks; ++b) read_element_block(in, nodes, entities, data);
  check_total(in, "elements", count, static_cast<Index>(data.rows.size()));
  end_section(in, "Elements");
}

}  // namespace palpate::inline PALPATE_ABI::io::gmsh::msh4
