// Definitions of gmsh_msh2.hpp.
#pragma once

#include <palpate/io/detail/gmsh_msh2.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh::msh2 {

/// Nodes: `id x y z` each.
PALPATE_INLINE void read_nodes(TextReader& in, State& state) {
  const Index count = read_count(in, "a number of nodes", 8);
  const Numbers numbers(in, state.format.is_binary, state.format.swap);
  state.mesh.positions.reserve(static_cast<std::size_t>(count));
  state.mesh.node_tags.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    numbers.begin("a node");
    state.mesh.node_tags.push_back(numbers.integer("a node id", 1, max_tag));
    state.mesh.positions.push_back(numbers.point());
    numbers.end("a node");
  }
}

namespace detail {

/// Reads `count` tags of an element and returns the physical tag, the first of them; 0 if there is none.
inline int read_tags(const Numbers& in, Index count) {
  const int physical = count > 0 ? read_physical(in) : 0;
  for (Index i = 1; i < count; ++i) in.integer("a tag", -max_int, max_int);
  return physical;
}

/// Reads the nodes of an element and adds it.
inline void add_element(const Numbers& in, const NodeIds& nodes, State& state, const Type& type, Index tag,
                        int physical) {
  const Index place = in.in.place();
  const auto set = state.sets.find_or_add(state.mesh, physical);
  for (int a = 0; a < facts(type.shape).nodes; ++a)
    state.mesh.cell_nodes.push_back(nodes.find(in.integer("a node id", 1, nodes.last()), in.in));
  state.mesh.add_cell(tag, place, type.shape, set, type.order);
}

/// An element of MSH 2 as text: `id type ntags tags... nodes...`.
inline void read_row(const Numbers& in, const NodeIds& nodes, State& state) {
  const Index tag = in.integer("an element id", 1, max_tag);
  const Type& type = read_type(in);
  const Index tags = in.integer("a number of tags", 0, max_int, SetupErrorKind::count_too_large);
  const int physical = read_tags(in, tags);
  add_element(in, nodes, state, type, tag, physical);
}

/// An element of MSH 1: `id type physical elementary nnodes nodes...`.
inline void read_old_row(const Numbers& in, const NodeIds& nodes, State& state) {
  const Index tag = in.integer("an element id", 1, max_tag);
  const Type& type = read_type(in);
  const int physical = read_tags(in, 2);
  const ShapeFacts& shape = facts(type.shape);
  if (const Index given = in.integer("a number of nodes", 1, max_int); given != shape.nodes)
    in.in.refuse(SetupErrorKind::bad_file, {shape.nodes, " nodes for a ", shape.name}, {given});
  add_element(in, nodes, state, type, tag, physical);
}

/// Binary elements of MSH 2 come in blocks: `type count ntags`, then `id tags... nodes...` each. Returns the count.
inline Index read_block(const Numbers& in, const NodeIds& nodes, State& state, Index left) {
  const Type& type = read_type(in);
  const Index count = in.integer("a number of elements in a block", 1, left, SetupErrorKind::count_too_large);
  const Index tags =
      in.integer("a number of tags", 0, static_cast<Index>(in.in.bytes_left()) / 4, SetupErrorKind::count_too_large);
  for (Index i = 0; i < count; ++i) {
    const Index tag = in.integer("an element id", 1, max_int);
    const int physical = read_tags(in, tags);
    add_element(in, nodes, state, type, tag, physical);
  }
  return count;
}

}  // namespace detail

PALPATE_INLINE void read_elements(TextReader& in, State& state) {
  const NodeIds nodes(state.mesh.node_tags, in);
  state.mesh.repeats_cells = true;
  const Index count = read_count(in, "a number of elements", 8);
  state.mesh.cells.reserve(static_cast<std::size_t>(count));
  const Numbers numbers(in, state.format.is_binary, state.format.swap);
  if (state.format.is_binary) {
    for (Index left = count; left > 0;) left -= detail::read_block(numbers, nodes, state, left);
    return;
  }
  for (Index i = 0; i < count; ++i) {
    in.need_line("an element");
    state.format.major == 1 ? detail::read_old_row(numbers, nodes, state) : detail::read_row(numbers, nodes, state);
    in.end_line("an element");
  }
}

}}}  // namespace palpate::PALPATE_ABI::io::gmsh::msh2
