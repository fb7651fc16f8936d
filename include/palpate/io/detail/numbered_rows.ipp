// Definitions of numbered_rows.hpp.
#pragma once

#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/numbered_rows.hpp>
#include <palpate/io/detail/numbers.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE Index RowNumbers::read(TextReader& in, std::string_view what) {
  const Index low = (base_ < 0 ? 0 : base_) + count_, high = base_ < 0 ? 1 : low;
  const Index id = in.integer(what, low, high);
  if (base_ < 0) base_ = id;
  ++count_;
  return id;
}

PALPATE_COLD PALPATE_INLINE NodeHeader NodeHeader::read(TextReader& in, std::size_t bytes_left) {
  NodeHeader h;
  h.count = in.integer("a number of nodes", 0, static_cast<Index>(bytes_left) / 7, SetupErrorKind::count_too_large);
  if (!in.rest().empty() && in.integer("the dimension", 2, 3) != 3)
    in.refuse(SetupErrorKind::unsupported, "nodes in 3 dimensions", "2");
  if (!in.rest().empty()) h.attributes = in.integer("a number of attributes", 0, max_int);
  if (!in.rest().empty()) h.markers = in.integer("0 or 1 for boundary markers", 0, 1);
  in.end_line("the header of the nodes");
  return h;
}

PALPATE_INLINE int read_node_row(TextReader& in, const NodeHeader& header, RowNumbers& numbers, FileMesh& mesh) {
  const Index id = numbers.read(in, "a node id");
  const Vector3 x = Numbers(in).point();
  for (Index i = 0; i < header.attributes; ++i) in.real("an attribute");
  const Index marker = header.markers == 0 ? 0 : in.integer("a boundary marker", -max_int, max_int);
  in.end_line("a node");
  mesh.node_tags.push_back(id);
  mesh.positions.push_back(x);
  return static_cast<int>(marker);
}

PALPATE_INLINE void read_cell_nodes(TextReader& in, int nodes, Index base, FileMesh& mesh) {
  const Index count = static_cast<Index>(mesh.positions.size());
  for (int a = 0; a < nodes; ++a)
    mesh.cell_nodes.push_back(static_cast<NodeId>(in.integer("a node id", base, base + count - 1) - base));
}

PALPATE_COLD PALPATE_INLINE CellHeader CellHeader::read(TextReader& in, CellShape shape, std::size_t bytes_left) {
  CellHeader h{0, 0, shape, {}};
  h.count = in.integer("a number of elements", 0, static_cast<Index>(bytes_left) / 9, SetupErrorKind::count_too_large);
  const Index nodes = in.rest().empty() ? facts(shape).nodes : in.integer("nodes of an element", 1, 64);
  if (nodes == 10 && shape == CellShape::tetrahedron4) {
    h.shape = CellShape::tetrahedron10;
    h.order = tetgen_tetrahedron10;
  } else if (nodes != facts(shape).nodes) {
    in.refuse(SetupErrorKind::bad_file, {facts(shape).nodes, " nodes of an element"}, {nodes});
  }
  if (!in.rest().empty()) h.attributes = in.integer("a number of attributes", 0, max_int);
  in.end_line("the header of the elements");
  return h;
}

}}}  // namespace palpate::PALPATE_ABI::io
