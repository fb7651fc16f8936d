// Numbered lines of nodes and cells, as in the files of TetGen and VegaFEM.
#pragma once

#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/file_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// Checks the ids of a file with numbered lines: each is one larger than the previous.
class RowNumbers {
 public:
  /// Reads the id of the next line. Refuses a first id other than 0 or 1, and gaps.
  Index read(TextReader& in, std::string_view what);
  Index base() const noexcept { return base_; }  ///< 0 or 1; -1 before the first line
  Index count() const noexcept { return count_; }

 private:
  Index base_ = -1, count_ = 0;
};

/// `count dimension attributes markers`; all but the count may be missing.
struct NodeHeader {
  Index count = 0, attributes = 0, markers = 0;

  /// Lines must fit into `bytes_left`.
  static NodeHeader read(TextReader& in, std::size_t bytes_left);
};

/// A node: `id x y z attributes... [marker]`. Returns the marker, 0 if there is none.
int read_node_row(TextReader& in, const NodeHeader& header, RowNumbers& numbers, FileMesh& mesh);

/// Reads `nodes` node ids counted from `base` into FileMesh::cell_nodes.
inline void read_cell_nodes(TextReader& in, int nodes, Index base, FileMesh& mesh) {
  const Index count = static_cast<Index>(mesh.positions.size());
  for (int a = 0; a < nodes; ++a)
    mesh.cell_nodes.push_back(static_cast<NodeId>(in.integer("a node id", base, base + count - 1) - base));
}

/// `count nodes attributes` of cells; all but the count may be missing.
struct CellHeader {
  Index count = 0, attributes = 0;
  CellShape shape = CellShape::tetrahedron4;
  NodeOrder order{};

  /// Lines must fit into `bytes_left`.
  static CellHeader read(TextReader& in, CellShape shape, std::size_t bytes_left);
};

inline Index RowNumbers::read(TextReader& in, std::string_view what) {
  const Index low = (base_ < 0 ? 0 : base_) + count_, high = base_ < 0 ? 1 : low;
  const Index id = in.integer(what, low, high);
  if (base_ < 0) base_ = id;
  ++count_;
  return id;
}

PALPATE_COLD inline NodeHeader NodeHeader::read(TextReader& in, std::size_t bytes_left) {
  NodeHeader h;
  h.count = in.integer("a number of nodes", 0, static_cast<Index>(bytes_left) / 7, SetupErrorKind::count_too_large);
  if (!in.rest().empty() && in.integer("the dimension", 2, 3) != 3)
    in.refuse(SetupErrorKind::unsupported, "nodes in 3 dimensions", "2");
  if (!in.rest().empty()) h.attributes = in.integer("a number of attributes", 0, max_int);
  if (!in.rest().empty()) h.markers = in.integer("0 or 1 for boundary markers", 0, 1);
  in.end_line("the header of the nodes");
  return h;
}

inline int read_node_row(TextReader& in, const NodeHeader& header, RowNumbers& numbers, FileMesh& mesh) {
  const Index id = numbers.read(in, "a node id");
  const Vector3 x = Numbers(in).point();
  for (Index i = 0; i < header.attributes; ++i) in.real("an attribute");
  const Index marker = header.markers == 0 ? 0 : in.integer("a boundary marker", -max_int, max_int);
  in.end_line("a node");
  mesh.node_tags.push_back(id);
  mesh.positions.push_back(x);
  return static_cast<int>(marker);
}

PALPATE_COLD inline CellHeader CellHeader::read(TextReader& in, CellShape shape, std::size_t bytes_left) {
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
