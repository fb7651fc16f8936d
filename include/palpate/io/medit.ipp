// Definitions of read_mesh.hpp: reads Medit files.
#pragma once

#include <palpate/io/detail/id_table.hpp>
#include <palpate/io/detail/medit_source.hpp>
#include <palpate/io/detail/node_order.hpp>
#include <palpate/io/detail/tag_sets.hpp>
#include <palpate/io/read_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::medit {

namespace detail {

/// Parses one file.
class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : source_(text, name), mesh_(name) {}

  FileMesh parse();

 private:
  void read(const Section& section);
  void read_vertices();
  void read_cells(const Section& section);
  void check_order(CellShape shape);
  void number_nodes();
  void add_points();

  std::uint32_t tag_set(int reference) { return sets_.find_or_add(mesh_, reference); }
  int reference() { return static_cast<int>(source_.integer("a reference", -max_int, max_int)); }
  TextReader& in() { return source_.in; }

  Source source_;
  FileMesh mesh_;
  bool has_dimension_ = false, has_vertices_ = false;
  std::vector<int> references_;  ///< of the vertices
  std::array<Index, sections.size()> last_cell_{};
  TagSets sets_;
};

inline FileMesh Parser::parse() {
  while (const Section* section = source_.next_section()) {
    read(*section);
    source_.end_section(*section);
  }
  if (!has_vertices_) in().refuse(SetupErrorKind::bad_file, "Vertices", "the end of the file");
  if (!source_.has_end()) mesh_.notes.push_back("there is no End: the file may be truncated");
  number_nodes();
  add_points();
  return std::move(mesh_);
}

inline void Parser::read(const Section& section) {
  if (section.kind == Section::dimension) {
    source_.need_dimension_3();
    has_dimension_ = true;
  } else if (section.kind == Section::vertices) {
    read_vertices();
  } else if (section.kind == Section::cells) {
    read_cells(section);
  } else if (section.kind == Section::order) {
    check_order(section.shape);
  } else if (section.kind == Section::bezier) {
    if (source_.integer("0 or 1 for control points", 0, 1) == 1)
      in().refuse(SetupErrorKind::unsupported, "nodes on the elements", "control points (BezierBasis)");
  } else {
    source_.real_bits = source_.integer("32 or 64 bits", 32, 64, SetupErrorKind::unsupported) == 32 ? 32 : 64;
  }
}

inline void Parser::read_vertices() {
  if (!has_dimension_) in().refuse(SetupErrorKind::bad_file, "Dimension before Vertices", "Vertices");
  has_vertices_ = true;
  const Index n = source_.count("a number of vertices", 3, 1);
  mesh_.positions.reserve(static_cast<std::size_t>(n));
  for (Index i = 0; i < n; ++i) {
    Vector3 x;
    for (int c = 0; c < 3; ++c) x[c] = source_.real("a coordinate");
    mesh_.positions.push_back(x);
    mesh_.node_tags.push_back(i + 1);
    references_.push_back(reference());
  }
}

/// Nodes keep their ids of the file until all sections are read.
inline void Parser::read_cells(const Section& section) {
  const CellShape shape = section.shape;
  Index& last = last_cell_[static_cast<std::size_t>(&section - sections.data())];
  const Index n = source_.count("a number of elements", 0, facts(shape).nodes + 1);
  for (Index i = 0; i < n; ++i) {
    source_.begin("an element");
    const Index place = in().location();
    for (int a = 0; a < facts(shape).nodes; ++a)
      mesh_.cell_nodes.push_back(static_cast<NodeId>(source_.integer("a node id", 1, max_int)));
    mesh_.add_cell(++last, place, shape, tag_set(reference()), {});
  }
}

/// A row of barycentric coordinates per node, times two: 2 at a corner, 1 at both ends of an edge.
PALPATE_COLD inline void Parser::check_order(CellShape shape) {
  const int corners = shape == CellShape::triangle6 ? 3 : 4, nodes = facts(shape).nodes;
  source_.integer("the number of nodes of an element", nodes, nodes, SetupErrorKind::bad_file);
  for (int k = 0; k < nodes; ++k)
    for (int c = 0; c < corners; ++c) {
      Index expected = k == c ? 2 : 0;
      if (k >= corners) {
        const auto& ends = tetrahedron_edges[static_cast<std::size_t>(k - corners)];
        expected = c == ends[0] || c == ends[1] ? 1 : 0;
      }
      if (const Index found = source_.integer("a coordinate of a node", 0, 2); found != expected)
        in().refuse(SetupErrorKind::unsupported, {"nodes in the order of VTK, so ", expected}, {found});
    }
}

inline void Parser::number_nodes() {
  const auto n = static_cast<Index>(mesh_.positions.size());
  for (const FileCell& cell : mesh_.cells)
    for (std::size_t a = 0; a < static_cast<std::size_t>(facts(cell.shape).nodes); ++a) {
      NodeId& node = mesh_.cell_nodes[cell.first_node + a];
      if (node > n)
        refuse(SetupErrorKind::index_out_of_range, {location_text(in().name(), cell.location),
                                                    ": expected a node id of at most ", n, ", found '", node, "'"});
      --node;
    }
}

/// Some programs give every vertex a reference of its own; those are no groups.
inline void Parser::add_points() {
  std::vector<int> different = references_;
  sort_unique(different);
  if (different.size() > max_groups / 2) {
    mesh_.notes.push_back(joined({different.size(), " references of vertices are not used: too many for groups"}));
    return;
  }
  for (std::size_t i = 0; i < references_.size(); ++i) {
    if (references_[i] == 0) continue;
    mesh_.cell_nodes.push_back(static_cast<NodeId>(i));
    mesh_.add_cell(static_cast<Index>(i) + 1, 1, CellShape::point, tag_set(references_[i]), {});
  }
}

}  // namespace detail

PALPATE_INLINE FileMesh parse(std::string_view text, const std::string& name) {
  return detail::Parser(text, name).parse();
}

}}}  // namespace palpate::PALPATE_ABI::io::medit
