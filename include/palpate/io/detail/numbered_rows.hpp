// Numbered lines of nodes and cells, as in the files of TetGen and VegaFEM.
#pragma once

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
void read_cell_nodes(TextReader& in, int nodes, Index base, FileMesh& mesh);

/// `count nodes attributes` of cells; all but the count may be missing.
struct CellHeader {
  Index count = 0, attributes = 0;
  CellShape shape = CellShape::tetrahedron4;
  NodeOrder order{};

  /// Lines must fit into `bytes_left`.
  static CellHeader read(TextReader& in, CellShape shape, std::size_t bytes_left);
};

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/numbered_rows.ipp>
#endif
