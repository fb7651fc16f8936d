// Reads the meshes of FEBio (*.feb), specification 2.0 to 4.0.
#pragma once

#include <palpate/io/detail/cell_shape.hpp>
#include <palpate/io/detail/id_table.hpp>
#include <palpate/io/detail/tag_sets.hpp>
#include <palpate/io/detail/vtk_numbers.hpp>
#include <palpate/io/file_mesh.hpp>
#include <palpate/io/xml/detail/document.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Reads a whole file. Every `<Elements>` is a region and a group, with its name (2.0: elset), else with the name of
/// its material ("material 1") or "part 1"; `<NodeSet>`, `<ElementSet>` and `<Surface>` are groups. Materials, loads
/// and all else are skipped; directions of fibres get a note. Ids are those of the file.
///
/// Errors: bad_file, index_out_of_range, non_finite, unsupported (other versions, element types without a shape here,
/// meshes in other files, parts with instances), with file and line. O(n log n) in the size of the text; memory of
/// about ten times its size.
FileMesh parse_febio(std::string_view text, const std::string& name);

/// A type with its shape; the order of nodes is that of VTK (FEBio User Manual, "Elements Section").
struct FebioType {
  std::string_view name;
  CellShape shape;
};

inline constexpr std::array febio_types{
    FebioType{"tet4", CellShape::tetrahedron4},  FebioType{"tet10", CellShape::tetrahedron10},
    FebioType{"hex8", CellShape::hexahedron8},   FebioType{"hex20", CellShape::hexahedron20},
    FebioType{"hex27", CellShape::hexahedron27}, FebioType{"penta6", CellShape::prism6},
    FebioType{"penta15", CellShape::prism15},    FebioType{"pyra5", CellShape::pyramid5},
    FebioType{"pyra13", CellShape::pyramid13},   FebioType{"tri3", CellShape::triangle3},
    FebioType{"tri6", CellShape::triangle6},     FebioType{"quad4", CellShape::quadrangle4},
    FebioType{"quad8", CellShape::quadrangle8},  FebioType{"quad9", CellShape::quadrangle9},
    FebioType{"q4ans", CellShape::quadrangle4},  FebioType{"q4eas", CellShape::quadrangle4},
    FebioType{"line2", CellShape::line2},        FebioType{"truss2", CellShape::line2},
    FebioType{"line3", CellShape::line3},
};

namespace detail {

/// Parses one file: `<Mesh>` of specification 3 and 4, `<Geometry>` of 2.
class FebioParser {
 public:
  FebioParser(std::string_view text, const std::string& name)
      : document_(text, name, {'\0', true, false}), mesh_(name) {}

  FileMesh parse();

 private:
  pugi::xml_node need_mesh();
  void read_part(pugi::xml_node part);
  void read_nodes(pugi::xml_node nodes);
  void read_elements(pugi::xml_node elements, int tag);
  CellShape shape_of(pugi::xml_node element, std::string_view type);
  void add_cell(pugi::xml_node element, CellShape shape, int tag);
  std::vector<Index> ids_of(pugi::xml_node set);
  void add_element_set(pugi::xml_node set, const IdTable& elements, std::vector<std::vector<int>>& tags);
  void add_node_set(pugi::xml_node set, const IdTable& nodes);
  void add_surface(pugi::xml_node surface);
  Index position_of(pugi::xml_node set, Index id, const IdTable& ids);
  std::string need_name(pugi::xml_node set);
  void number_nodes(const IdTable& nodes);
  void note_fibres(pugi::xml_node mesh);

  Document document_;
  FileMesh mesh_;
  TagSets known_;
  std::vector<Index> node_lines_, element_ids_, element_lines_;
  int last_tag_ = 0;
};

inline pugi::xml_node FebioParser::need_mesh() {
  const pugi::xml_node file = document_.root();
  if (std::string_view(file.name()) != "febio_spec")
    document_.refuse(file, SetupErrorKind::bad_file, "<febio_spec>", in_quotes(file.name()));
  const std::string_view version = document_.need_attribute(file, "version");
  if (version.size() < 3 || version[0] < '2' || version[0] > '4' || version[1] != '.')
    document_.refuse(file, SetupErrorKind::unsupported, "version 2.0 to 4.0", in_quotes(version),
                     "Open it in FEBio Studio and export it as version 4.0");
  const pugi::xml_node mesh = document_.need_child(file, version[0] == '2' ? "Geometry" : "Mesh");
  for (const char* other : {"from", "import"})
    if (mesh.attribute(other))
      document_.refuse(mesh, SetupErrorKind::unsupported, "the mesh in this file",
                       {"the file ", mesh.attribute(other).value()}, "Read that file");
  return mesh;
}

inline FileMesh FebioParser::parse() {
  const pugi::xml_node mesh = need_mesh();
  for (const pugi::xml_node part : mesh.children()) read_part(part);
  mesh_.last_region = last_tag_;
  TextReader& in = document_.text_of({});
  const IdTable nodes(mesh_.node_tags, node_lines_, "node", in);
  const IdTable elements(element_ids_, element_lines_, "element", in);
  std::vector<std::vector<int>> tags;
  for (const FileCell& cell : mesh_.cells) tags.push_back(mesh_.tag_sets[cell.tag_set]);
  for (const pugi::xml_node set : mesh.children("ElementSet")) add_element_set(set, elements, tags);
  for (std::size_t c = 0; c < tags.size(); ++c) mesh_.cells[c].tag_set = known_.find_or_add(mesh_, tags[c]);
  for (const pugi::xml_node surface : mesh.children("Surface")) add_surface(surface);
  number_nodes(nodes);
  for (const pugi::xml_node set : mesh.children("NodeSet")) add_node_set(set, nodes);
  note_fibres(mesh);
  return std::move(mesh_);
}

inline void FebioParser::read_part(pugi::xml_node part) {
  const std::string_view name = part.name();
  if (name == "Nodes") return read_nodes(part);
  if (name == "Part" || name == "Instance")
    document_.refuse(part, SetupErrorKind::unsupported, "<Nodes> and <Elements>", {"<", name, ">"},
                     "Open it in FEBio Studio and export it as version 4.0");
  if (name != "Elements") return;
  const std::string_view by_name = part.attribute("name").value(), elset = part.attribute("elset").value();
  const std::string_view material = part.attribute("mat").value();
  std::string group(by_name.empty() ? elset : by_name);
  if (group.empty()) group = material.empty() ? joined({"part ", last_tag_ + 1}) : joined({"material ", material});
  const std::size_t first = mesh_.cells.size();
  read_elements(part, ++last_tag_);
  const int dimension = first < mesh_.cells.size() ? facts(mesh_.cells[first].shape).dimension : 3;
  mesh_.names.push_back({dimension, last_tag_, std::move(group)});
}

inline void FebioParser::read_nodes(pugi::xml_node nodes) {
  for (const pugi::xml_node node : nodes.children("node")) {
    node_lines_.push_back(document_.line_of(node));
    mesh_.node_tags.push_back(document_.integer(node, "id", 1, max_int));
    TextReader& in = document_.text_of(node);
    Vector3 x;
    for (int c = 0; c < 3; ++c) x[c] = in.real("a coordinate");
    in.end_line("a node");
    mesh_.positions.push_back(x);
  }
}

inline CellShape FebioParser::shape_of(pugi::xml_node element, std::string_view type) {
  for (const FebioType& known : febio_types) {
    const std::string_view rule = type.substr(std::min(known.name.size(), type.size()));  // of integration, such as G8
    const bool is_rule =
        rule.empty() || vtk::same_word(rule.substr(0, 1), "g") || vtk::same_word(rule.substr(0, 1), "m");
    if (is_rule && vtk::same_word(known.name, type.substr(0, known.name.size()))) return known.shape;
  }
  document_.refuse(element, SetupErrorKind::unsupported, "elements tet4, tet10, hex8 or hex20", in_quotes(type),
                   "Convert or remove these elements in FEBio Studio");
}

inline void FebioParser::read_elements(pugi::xml_node elements, int tag) {
  const CellShape shape = shape_of(elements, document_.need_attribute(elements, "type"));
  for (const pugi::xml_node element : elements.children("elem")) {
    element_lines_.push_back(document_.line_of(element));
    element_ids_.push_back(document_.integer(element, "id", 1, max_int));
    add_cell(element, shape, tag);
    mesh_.cells.back().tag = element_ids_.back();
  }
}

/// The ids of nodes are replaced by positions at the end.
inline void FebioParser::add_cell(pugi::xml_node element, CellShape shape, int tag) {
  TextReader& in = document_.text_of(element);
  const Index line = in.location();
  for (int a = 0; a < facts(shape).nodes; ++a) {
    in.need_more("a node id");
    mesh_.cell_nodes.push_back(static_cast<NodeId>(in.integer("a node id", 1, max_int)));
  }
  in.end_line("an element");
  mesh_.add_cell(0, line, shape, known_.find_or_add(mesh_, tag), {});
}

/// Fibres and axes of single elements are in `<MeshData>`, in version 2.0 in `<Geometry>`.
inline void FebioParser::note_fibres(pugi::xml_node mesh) {
  std::string_view lost;
  const auto look_at = [&](std::string_view name) {
    if (name == "fiber" || name == "mat_axis") lost = name;
  };
  for (const pugi::xml_node data : document_.root().child("MeshData").children()) {
    look_at(data.attribute("type").value());
    look_at(data.attribute("var").value());
    look_at(data.attribute("name").value());
  }
  for (const pugi::xml_node element : mesh.child("ElementData").children())
    for (const pugi::xml_node data : element.children()) look_at(data.name());
  if (!lost.empty())
    mesh_.notes.push_back(
        joined({"<ElementData> of the type '", lost, "' is not read: enter directions in Mesh::fibres"}));
}

inline void FebioParser::number_nodes(const IdTable& nodes) {
  for (const FileCell& cell : mesh_.cells)
    for (std::size_t a = 0; a < static_cast<std::size_t>(facts(cell.shape).nodes); ++a) {
      NodeId& node = mesh_.cell_nodes[cell.first_node + a];
      const Index found = nodes.find(node);
      if (found < 0)
        refuse_at(document_.text_of({}), cell.location, SetupErrorKind::index_out_of_range,
                  "the id of a node of this file", {"'", node, "' in element ", cell.tag});
      node = static_cast<NodeId>(found);
    }
}

/// Children with an id each, or a text with ids.
inline std::vector<Index> FebioParser::ids_of(pugi::xml_node set) {
  std::vector<Index> ids;
  for (const pugi::xml_node child : set.children())
    if (child.type() == pugi::node_element) ids.push_back(document_.integer(child, "id", 1, max_int));
  if (!ids.empty()) return ids;
  TextReader& in = document_.text_of(set);
  while (!in.rest().empty() || in.next_line()) ids.push_back(in.integer("an id", 1, max_int));
  return ids;
}

inline Index FebioParser::position_of(pugi::xml_node set, Index id, const IdTable& ids) {
  const Index found = ids.find(id);
  if (found < 0)
    document_.refuse(set, SetupErrorKind::index_out_of_range, {"the id of a ", ids.what, " of this file"},
                     {"'", id, "'"});
  return found;
}

inline std::string FebioParser::need_name(pugi::xml_node set) {
  const std::string_view name = document_.need_attribute(set, "name");
  if (name.empty()) document_.refuse(set, SetupErrorKind::bad_file, {"a name of <", set.name(), ">"}, "none");
  return std::string(name);
}

inline void FebioParser::add_element_set(pugi::xml_node set, const IdTable& elements,
                                         std::vector<std::vector<int>>& tags) {
  const std::string name = need_name(set);
  std::array<bool, 4> has_dimension{};
  ++last_tag_;
  for (const Index id : ids_of(set)) {
    const auto at = static_cast<std::size_t>(position_of(set, id, elements));
    if (tags[at].empty() || tags[at].back() != last_tag_) tags[at].push_back(last_tag_);
    has_dimension[static_cast<std::size_t>(facts(mesh_.cells[at].shape).dimension)] = true;
  }
  for (int d = 1; d < 4; ++d)
    if (has_dimension[static_cast<std::size_t>(d)]) mesh_.names.push_back({d, last_tag_, name});
}

inline void FebioParser::add_node_set(pugi::xml_node set, const IdTable& nodes) {
  mesh_.names.push_back({0, ++last_tag_, need_name(set)});
  const std::uint32_t tag_set = known_.find_or_add(mesh_, last_tag_);
  const Index line = document_.line_of(set);
  for (const Index id : ids_of(set)) {
    mesh_.cell_nodes.push_back(static_cast<NodeId>(position_of(set, id, nodes)));
    mesh_.add_cell(id, line, CellShape::point, tag_set, {});
  }
}

inline void FebioParser::add_surface(pugi::xml_node surface) {
  mesh_.names.push_back({2, ++last_tag_, need_name(surface)});
  for (const pugi::xml_node face : surface.children()) {
    if (face.type() != pugi::node_element) continue;
    const CellShape shape = shape_of(face, face.name());
    if (facts(shape).dimension != 2) document_.refuse(face, SetupErrorKind::bad_file, "a face", in_quotes(face.name()));
    add_cell(face, shape, last_tag_);
  }
}

}  // namespace detail

inline FileMesh parse_febio(std::string_view text, const std::string& name) {
  return detail::FebioParser(text, name).parse();
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
