// The node and element sections of Gmsh's formats 1 and 2 (MSH 1, MSH 2.0 to 2.2).
#pragma once

#include <palpate/io/gmsh_types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh::msh2 {

/// Nodes: `id x y z` each.
template <class In>
void read_node_rows(In in, Index count, FileMesh& mesh) {
  mesh.positions.reserve(static_cast<std::size_t>(count));
  mesh.node_tags.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    in.begin("a node");
    mesh.node_tags.push_back(in.integer("a node id", 1, max_tag));
    mesh.positions.push_back(read_point(in));
    in.end("a node");
  }
}

/// $Nodes (in MSH 1 $NOD): the count, then the nodes.
inline void read_nodes(TextReader& in, State& state) {
  const Index count = read_count(in, "a number of nodes", 8);
  if (state.format.is_binary)
    read_node_rows(BinaryNumbers{in, state.format.swap}, count, state.mesh);
  else
    read_node_rows(TextNumbers{in}, count, state.mesh);
}

/// Reads `count` tags of an element and returns the physical tag, the first of them; 0 when there is none.
template <class In>
int read_tags(In& in, Index count) {
  const int physical = count > 0 ? read_physical(in) : 0;
  for (Index i = 1; i < count; ++i) in.integer("a tag", -max_int, max_int);
  return physical;
}

/// Reads the nodes of an element and adds it.
template <class In>
void add_element(In& in, const NodeIds& nodes, State& state, const Type& type, Index tag, int physical) {
  const Index place = in.in.place();
  const auto set = state.mesh.set_of(state.sets, physical == 0 ? std::vector<int>{} : std::vector<int>{physical});
  for (int a = 0; a < facts(type.shape).nodes; ++a)
    state.mesh.cell_nodes.push_back(nodes.find(in.integer("a node id", 1, nodes.last()), in.in));
  state.mesh.add_cell(tag, place, type.shape, set, type.order);
}

/// An element of MSH 2 as text: `id type ntags tags... nodes...`.
inline void read_row(TextNumbers in, const NodeIds& nodes, State& state) {
  const Index tag = in.integer("an element id", 1, max_tag);
  const Type* type = read_type(in, in.in);
  const Index tags = in.integer("a number of tags", 0, max_int, SetupErrorKind::count_too_large);
  const int physical = read_tags(in, tags);
  add_element(in, nodes, state, *type, tag, physical);
}

/// An element of MSH 1: `id type physical elementary nnodes nodes...`.
inline void read_old_row(TextNumbers in, const NodeIds& nodes, State& state) {
  const Index tag = in.integer("an element id", 1, max_tag);
  const Type* type = read_type(in, in.in);
  const int physical = read_tags(in, 2);
  const int count = facts(type->shape).nodes;
  if (const Index given = in.integer("a number of nodes", 1, max_int); given != count)
    in.in.refuse(SetupErrorKind::bad_file,
                 std::to_string(count) + " nodes for a " + std::string(facts(type->shape).name), std::to_string(given));
  add_element(in, nodes, state, *type, tag, physical);
}

/// Binary elements of MSH 2 come in blocks: `type count ntags`, then `id tags... nodes...` each. Returns the count.
inline Index read_block(BinaryNumbers in, const NodeIds& nodes, State& state, Index left) {
  const Type* type = read_type(in, in.in);
  const Index count = in.integer("a number of elements in a block", 1, left, SetupErrorKind::count_too_large);
  const Index tags =
      in.integer("a number of tags", 0, static_cast<Index>(in.in.bytes_left()) / 4, SetupErrorKind::count_too_large);
  for (Index i = 0; i < count; ++i) {
    const Index tag = in.integer("an element id", 1, max_int);
    const int physical = read_tags(in, tags);
    add_element(in, nodes, state, *type, tag, physical);
  }
  return count;
}

/// $Elements (in MSH 1 $ELM). An element of several physical groups comes several times.
inline void read_elements(TextReader& in, State& state) {
  const NodeIds nodes(state.mesh.node_tags, in);
  state.mesh.repeats_cells = true;
  const Index count = read_count(in, "a number of elements", 8);
  state.mesh.cells.reserve(static_cast<std::size_t>(count));
  if (state.format.is_binary) {
    for (Index left = count; left > 0;) left -= read_block({in, state.format.swap}, nodes, state, left);
    return;
  }
  for (Index i = 0; i < count; ++i) {
    in.need_line("an element");
    state.format.major == 1 ? read_old_row({in}, nodes, state) : read_row({in}, nodes, state);
    in.end_line("an element");
  }
}

}}}  // namespace palpate::io::gmsh::msh2
