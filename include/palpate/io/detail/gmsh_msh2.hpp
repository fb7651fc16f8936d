// The node and element sections of Gmsh's formats 1 and 2 (MSH 1, MSH 2.0 to 2.2).
#pragma once

#include <palpate/io/detail/gmsh_state.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh::msh2 {

/// $Nodes (in MSH 1 $NOD): the count, then the nodes. $ParametricNodes adds the entity of each node and its parameters,
/// which are skipped.
void read_nodes(TextReader& in, State& state, bool is_parametric);

/// $Elements (in MSH 1 $ELM). An element in several physical groups is listed several times.
void read_elements(TextReader& in, State& state);

namespace detail {

/// The rest of a parametric node: dimension and tag of its entity, one parameter on a curve, two on a surface.
PALPATE_COLD inline void skip_parameters(const Numbers& in) {
  const Index dimension = in.integer("the dimension of an entity", 0, 3);
  in.integer("the tag of an entity", -max_int, max_int);
  in.skip_reals(dimension == 3 ? 0 : static_cast<int>(dimension), "the parameters of a node");
}

}  // namespace detail

/// Nodes: `id x y z` each.
inline void read_nodes(TextReader& in, State& state, bool is_parametric) {
  const Index count = read_count(in, "a number of nodes", 8);
  const Numbers numbers(in, state.format.is_binary, state.format.swap);
  state.mesh.positions.reserve(static_cast<std::size_t>(count));
  state.mesh.node_tags.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    numbers.begin("a node");
    state.mesh.node_tags.push_back(numbers.integer("a node id", 1, max_tag));
    state.mesh.positions.push_back(numbers.point());
    if (is_parametric) detail::skip_parameters(numbers);
    numbers.end("a node");
  }
}

namespace detail {

/// Reads `count` tags of an element: the physical one, the elementary one, and others. Returns the one that is used; 0
/// if there is none.
inline int read_tags(const Numbers& in, State& state, CellShape shape, Index count) {
  const int physical = count > 0 ? read_physical(in) : 0;
  const auto elementary = count > 1 ? static_cast<int>(in.integer("a tag", -max_int, max_int)) : 0;
  for (Index i = 2; i < count; ++i) in.integer("a tag", -max_int, max_int);
  return used_tag(state, shape, physical, elementary);
}

/// Whether the last cell repeats the one before: an element in two physical groups.
inline bool is_repeated(const FileMesh& mesh) {
  if (mesh.cells.size() < 2) return false;
  const FileCell &last = mesh.cells.back(), &before = mesh.cells[mesh.cells.size() - 2];
  const NodeId* nodes = mesh.cell_nodes.data() + last.first_node;
  return last.shape == before.shape && last.tag_set == before.tag_set &&
         std::equal(nodes, nodes + facts(last.shape).nodes, mesh.cell_nodes.data() + before.first_node);
}

/// Reads the nodes of an element and adds it.
inline void add_element(const Numbers& in, const NodeIds& nodes, State& state, const Type& type, Index tag, int used) {
  const Index place = in.in.location();
  const auto set = state.sets.find_or_add(state.mesh, used);
  for (int a = 0; a < facts(type.shape).nodes; ++a)
    state.mesh.cell_nodes.push_back(nodes.find(in.integer("a node id", 1, nodes.last()), in.in));
  state.mesh.add_cell(tag, place, type.shape, set, type.order);
  if (!state.by_elementary || !is_repeated(state.mesh)) return;
  state.mesh.cell_nodes.resize(state.mesh.cells.back().first_node);
  state.mesh.cells.pop_back();
}

/// An element of MSH 2 as text: `id type ntags tags... nodes...`.
inline void read_row(const Numbers& in, const NodeIds& nodes, State& state) {
  const Index tag = in.integer("an element id", 1, max_tag);
  const Type& type = read_type(in);
  const Index tags = in.integer("a number of tags", 0, max_int, SetupErrorKind::count_too_large);
  const int used = read_tags(in, state, type.shape, tags);
  add_element(in, nodes, state, type, tag, used);
}

/// An element of MSH 1: `id type physical elementary nnodes nodes...`.
inline void read_old_row(const Numbers& in, const NodeIds& nodes, State& state) {
  const Index tag = in.integer("an element id", 1, max_tag);
  const Type& type = read_type(in);
  const int used = read_tags(in, state, type.shape, 2);
  const ShapeFacts& shape = facts(type.shape);
  if (const Index given = in.integer("a number of nodes", 1, max_int); given != shape.nodes)
    in.in.refuse(SetupErrorKind::bad_file, {shape.nodes, " nodes for a ", shape.name}, {given});
  add_element(in, nodes, state, type, tag, used);
}

/// Binary elements of MSH 2 come in blocks: `type count ntags`, then `id tags... nodes...` each. Returns the count.
inline Index read_block(const Numbers& in, const NodeIds& nodes, State& state, Index left) {
  const Type& type = read_type(in);
  const Index count = in.integer("a number of elements in a block", 1, left, SetupErrorKind::count_too_large);
  const Index tags =
      in.integer("a number of tags", 0, static_cast<Index>(in.in.bytes_left()) / 4, SetupErrorKind::count_too_large);
  for (Index i = 0; i < count; ++i) {
    const Index tag = in.integer("an element id", 1, max_int);
    const int used = read_tags(in, state, type.shape, tags);
    add_element(in, nodes, state, type, tag, used);
  }
  return count;
}

}  // namespace detail

inline void read_elements(TextReader& in, State& state) {
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
