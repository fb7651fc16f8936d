// Definitions of read_mesh.hpp: reads the files of TetGen.
#pragma once

#include <palpate/io/detail/numbered_rows.hpp>
#include <palpate/io/detail/tag_sets.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/read_mesh.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace io::tetgen {

namespace detail {

inline constexpr TextSyntax syntax{'#', false};

/// State while the files of a mesh are read.
struct State {
  explicit State(const std::string& name) : mesh(joined({name, ".node"})) {
    mesh.files.push_back(joined({name, ".ele"}));
    mesh.files.push_back(joined({name, ".face"}));
  }
  FileMesh mesh;
  Index base = 0;  ///< the id of the first node
  bool is_second_order = false;
  TagSets sets;
};

/// Refuses lines after the announced number of lines, and a truncated last line.
PALPATE_COLD inline void need_end(TextReader& in, std::string_view what, Index count) {
  if (in.next_line())
    in.refuse(SetupErrorKind::bad_file, {"the end of the file after ", count, " ", what}, in_quotes(in.line()));
  in.need_last_line_end();
}

/// x.node. A node with a boundary marker other than 0 becomes a point of that tag.
inline void read_nodes(TextReader& in, State& state) {
  in.need_line("the header of the nodes");
  const NodeHeader header = NodeHeader::read(in, in.bytes_left());
  RowNumbers numbers;
  for (Index i = 0; i < header.count; ++i) {
    in.need_line("a node");
    const int marker = read_node_row(in, header, numbers, state.mesh);
    if (marker == 0) continue;
    state.mesh.cell_nodes.push_back(static_cast<NodeId>(i));
    state.mesh.add_cell(i, in.location(), CellShape::point, state.sets.find_or_add(state.mesh, marker), {});
  }
  need_end(in, "nodes", header.count);
  state.base = std::max<Index>(numbers.base(), 0);
}

/// Reads the attributes of a tetrahedron: the first is its region, an integer.
inline int read_region(TextReader& in, Index attributes) {
  int region = 0;
  for (Index i = 0; i < attributes; ++i) {
    const double value = in.real("an attribute");
    if (i > 0) continue;
    if (value != std::floor(value) || std::abs(value) > static_cast<double>(max_int))
      in.refuse(SetupErrorKind::unsupported, "a whole number for the region", value,
                "Number the regions with whole numbers (tetgen -A)");
    region = static_cast<int>(value);
  }
  return region;
}

/// x.ele.
inline void read_elements(TextReader& in, State& state) {
  in.need_line("the header of the elements");
  const CellHeader header = CellHeader::read(in, CellShape::tetrahedron4, in.bytes_left());
  state.is_second_order = header.shape == CellShape::tetrahedron10;
  for (Index i = 0; i < header.count; ++i) {
    in.need_line("an element");
    const Index place = in.location(),
                id = in.integer("an element id counted like the nodes", state.base + i, state.base + i);
    read_cell_nodes(in, facts(header.shape).nodes, state.base, state.mesh);
    const int region = read_region(in, header.attributes);
    in.end_line("an element");
    const std::uint32_t set = state.sets.find_or_add(state.mesh, region);
    state.mesh.add_cell(id, place, header.shape, set, header.order, 1);
  }
  need_end(in, "elements", header.count);
}

/// x.face: `count markers`, then `id nodes... [marker] [neighbours]`. Faces without a marker belong to no group.
inline void read_faces(TextReader& in, State& state) {
  in.need_line("the header of the faces");
  const Index count = in.count("a number of faces", 7);
  const Index markers = in.rest().empty() ? 0 : in.integer("0 or 1 for boundary markers", 0, 1);
  in.end_line("the header of the faces");
  const CellShape shape = state.is_second_order ? CellShape::triangle6 : CellShape::triangle3;
  for (Index i = 0; i < count; ++i) {
    in.need_line("a face");
    const Index place = in.location(),
                id = in.integer("a face id counted like the nodes", state.base + i, state.base + i);
    read_cell_nodes(in, facts(shape).nodes, state.base, state.mesh);
    const auto marker = markers == 0 ? 0 : static_cast<int>(in.integer("a boundary marker", -max_int, max_int));
    for (int n = 0; n < 2 && !in.rest().empty(); ++n) in.integer("a neighbour", -1, max_int);
    in.end_line("a face");
    const std::uint32_t set = state.sets.find_or_add(state.mesh, marker);
    state.mesh.add_cell(id, place, shape, set, {}, 2);
  }
  need_end(in, "faces", count);
}

}  // namespace detail

PALPATE_INLINE FileMesh parse(const Texts& texts) {
  detail::State state(texts.name);
  TextReader nodes(texts.node, state.mesh.files[0], detail::syntax);
  TextReader elements(texts.ele, state.mesh.files[1], detail::syntax);
  detail::read_nodes(nodes, state);
  detail::read_elements(elements, state);
  TextReader faces(texts.face, state.mesh.files[2], detail::syntax);
  if (!texts.face.empty()) detail::read_faces(faces, state);
  return std::move(state.mesh);
}

PALPATE_INLINE FileMesh read(const std::string& path) {
  const std::string name = path.substr(0, path.size() - ending_of(path).size());
  const std::string ele_file = joined({name, ".ele"}), face_file = joined({name, ".face"});
  if (!is_there(ele_file))
    refuse(SetupErrorKind::unsupported, {ele_file, ": expected the elements of ", path, ", found no such file"},
           {"Nodes and faces alone are a surface; tetgen -pq ", name, ".poly fills one"});
  const std::string node = read_file(joined({name, ".node"})), ele = read_file(ele_file);
  const std::string face = is_there(face_file) ? read_file(face_file) : std::string{};
  return parse({name, node, ele, face});
}

}}}  // namespace palpate::PALPATE_ABI::io::tetgen
