// The node and element sections of Gmsh's format 2 (MSH 2.0 to 2.2), ASCII.
#pragma once

#include <palpate/io/gmsh_data.hpp>

#include <map>

namespace palpate::inline PALPATE_ABI::io::gmsh::msh2 {

/// $Nodes: `count`, then `id x y z` per line.
inline void read_nodes(TextReader& in, Data& data) {
  in.need_line("the number of nodes");
  const Index count = in.count("a number of nodes", 8);
  in.end_line("the number of nodes");
  data.positions.reserve(static_cast<std::size_t>(count));
  data.node_tags.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    in.need_line("a node");
    data.node_tags.push_back(in.integer("a node id", 1, max_tag));
    data.positions.push_back(read_point(in));
    in.end_line("a node");
  }
  end_section(in, "Nodes");
}

/// Reads `count tags ...` of an element and returns the physical tag, the first of them; 0 when there is none.
inline int read_tags(TextReader& in) {
  const Index count = in.integer("a number of tags", 0, max_int, SetupErrorKind::count_too_large);
  const int physical = count > 0 ? read_physical(in) : 0;
  for (Index i = 1; i < count; ++i) in.integer("a tag", -max_int, max_int);
  return physical;
}

/// $Elements: `count`, then `id type ntags tags... nodes...` per line. An element of several physical groups comes
/// several times.
inline void read_elements(TextReader& in, Data& data) {
  const NodeLookup nodes(data.node_tags, in);
  std::map<int, std::size_t> sets{{0, 0}};
  in.need_line("the number of elements");
  const Index count = in.count("a number of elements", 8);
  in.end_line("the number of elements");
  data.rows.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    in.need_line("an element");
    const Index tag = in.integer("an element id", 1, max_tag);
    const Type* type = read_type(in);
    const int physical = read_tags(in);
    const auto [set, is_new] = sets.try_emplace(physical, data.physical_sets.size());
    if (is_new) data.physical_sets.push_back({physical});
    data.rows.push_back({tag, in.line_number(), data.row_nodes.size(), type, set->second});
    for (int a = 0; a < type->nodes; ++a) data.row_nodes.push_back(nodes.read(in));
    in.end_line("an element");
  }
  end_section(in, "Elements");
}

}  // namespace palpate::inline PALPATE_ABI::io::gmsh::msh2
