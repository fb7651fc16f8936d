// Definitions of read_mesh.hpp: reads Abaqus and CalculiX files.
#pragma once

#include <palpate/io/detail/abaqus_groups.hpp>
#include <palpate/io/detail/abaqus_lines.hpp>
#include <palpate/io/read_mesh.hpp>

#include <array>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// Reads the lines that define groups; the current line is the keyword.
class Definitions {
 public:
  explicit Definitions(Lines& lines) : lines_(lines) {}

  void read_node_set() { read_set(groups.nodes, "NSET"); }
  void read_element_set() { read_set(groups.elements, "ELSET"); }

  /// Surfaces of other types than ELEMENT and NODE have no faces of elements and are skipped.
  void read_surface();

  /// Shells and beams have other keywords.
  void read_solid_section();

  Groups groups;
  bool in_assembly =
      false;             ///< ids without an instance are those of reference points of the assembly: they are skipped
  std::string instance;  ///< its name, in upper case

 private:
  void read_set(Sets& sets, std::string_view name_parameter);
  void read_set_line(Sets& sets, bool ids_are_foreign);
  void read_range(Sets& sets);
  void read_surface_line(Surface& surface, bool is_of_nodes);
  Index find_set(const Sets& sets, std::string_view name) const;

  /// "Part-1-1.Set-1" is Set-1 of the instance.
  std::string_view without_instance(std::string_view name) const;

  Lines& lines_;
};

namespace detail {

inline bool is_number(std::string_view field) {
  return !field.empty() && (field[0] == '-' || field[0] == '+' || (field[0] >= '0' && field[0] <= '9'));
}

}  // namespace detail

PALPATE_COLD PALPATE_INLINE std::string_view Definitions::without_instance(std::string_view name) const {
  const std::size_t dot = name.find('.');
  const bool has_instance = dot < name.size() && !instance.empty() && upper(name.substr(0, dot)) == instance;
  return without_quotes(has_instance ? name.substr(dot + 1) : name);
}

PALPATE_COLD PALPATE_INLINE Index Definitions::find_set(const Sets& sets, std::string_view name) const {
  const Index set = sets.find(name, in_assembly);
  if (set < 0) lines_.in.refuse(SetupErrorKind::bad_file, "a set above in this file", in_quotes(name));
  return set;
}

PALPATE_INLINE void Definitions::read_set(Sets& sets, std::string_view name_parameter) {
  lines_.read_parameters();
  const std::string name = lines_.need_value(name_parameter);
  const bool is_foreign = in_assembly && !lines_.has("INSTANCE");
  sets.open(name, in_assembly, lines_.has("INTERNAL"));
  if (name_parameter == "NSET" && lines_.has("ELSET"))
    sets.add_nodes_of(find_set(groups.elements, without_instance(lines_.need_value("ELSET"))));
  while (lines_.next_data()) {
    if (!lines_.has("GENERATE"))
      read_set_line(sets, is_foreign);
    else if (!is_foreign)
      read_range(sets);
  }
}

PALPATE_INLINE void Definitions::read_set_line(Sets& sets, bool ids_are_foreign) {
  while (!lines_.in.rest().empty()) {
    const std::string_view rest = lines_.in.rest();
    if (!detail::is_number(rest)) {
      const std::string_view whole = lines_.in.token(), name = without_instance(whole);
      if (!detail::is_number(name) || name.size() == whole.size()) {
        sets.add_set(find_set(sets, name));
        continue;
      }
      TextReader digits(name, lines_.in.name());
      digits.next_line();
      const Index id = digits.integer("an id", 1, max_int);
      sets.add_ids(id, id, 1, lines_.in.location());
      continue;
    }
    const Index id = lines_.in.integer("an id", 1, max_int);
    if (!ids_are_foreign) sets.add_ids(id, id, 1, lines_.in.location());
  }
}

PALPATE_INLINE void Definitions::read_range(Sets& sets) {
  const Index first = lines_.in.integer("a first id", 1, max_int),
              last = lines_.in.integer("a last id", first, max_int);
  const Index step = lines_.in.rest().empty() ? 1 : lines_.in.integer("a step of ids", 1, max_int);
  lines_.in.end_line("a range of ids");
  sets.add_ids(first, last, step, lines_.in.location());
}

PALPATE_INLINE void Definitions::read_surface() {
  lines_.read_parameters();
  const std::string type = upper(lines_.value("TYPE"));
  const bool is_of_nodes = type == "NODE";
  if (!is_of_nodes && !type.empty() && type != "ELEMENT") return;
  if (lines_.has("COMBINE")) lines_.refuse_keyword("a surface of faces", "Write the faces of the combined surface");
  Surface surface{lines_.need_value("NAME"), {}};
  while (lines_.next_data()) read_surface_line(surface, is_of_nodes);
  groups.surfaces.push_back(std::move(surface));
}

PALPATE_INLINE void Definitions::read_surface_line(Surface& surface, bool is_of_nodes) {
  const Sets& sets = is_of_nodes ? groups.nodes : groups.elements;
  SurfacePart part{-1, -1, SurfacePart::of_nodes, lines_.in.location()};
  if (detail::is_number(lines_.in.rest())) {
    part.id = lines_.in.integer("an id", 1, max_int);
  } else {
    part.set = find_set(sets, without_instance(lines_.in.token()));
  }
  if (!is_of_nodes) {
    const std::string_view face = lines_.in.token();
    const std::string name = upper(face);
    if (name.size() == 2 && name[0] == 'S' && name[1] >= '1' && name[1] <= '6')
      part.face = name[1] - '1';
    else if (name == "SPOS" || name == "SNEG" || name == "S" || name.empty())
      part.face = SurfacePart::shell;
    else
      lines_.in.refuse(SetupErrorKind::unsupported, "a face S1 to S6, SPOS or SNEG", in_quotes(face));
  }
  surface.parts.push_back(part);
}

PALPATE_COLD PALPATE_INLINE void Definitions::read_solid_section() {
  lines_.read_parameters();
  if (in_assembly || lines_.value("ELSET").empty()) return;
  groups.sections.push_back(find_set(groups.elements, lines_.value("ELSET")));
}

namespace detail {

/// Parses one file (Abaqus Analysis User's Manual, "Input syntax rules"; CalculiX CrunchiX User's Manual).
class Parser {
 public:
  Parser(std::string_view text, const std::string& name) : lines_(text, name), mesh_(name) {}

  FileMesh parse();

 private:
  /// Where the current line is. Nodes and elements of the assembly itself are reference points and connectors: they are
  /// skipped.
  enum class Scope { model, part, assembly, instance };

  void read_section();
  void change_scope();
  void read_nodes();
  double coordinate();
  void read_elements();
  void skip_elements();
  void read_definition();
  void read_instance();

  [[noreturn]] void refuse_include();
  [[noreturn]] void refuse_generator();
  TextReader& in() { return lines_.in; }

  Lines lines_;
  FileMesh mesh_;
  Scope scope_ = Scope::model;
  bool has_part_ = false, has_instance_ = false;
  Vector3 translation_ = Vector3::Zero();
  std::vector<Index> node_lines_, element_ids_, element_lines_, cells_;
  Definitions definitions_{lines_};
};

inline FileMesh Parser::parse() {
  while (lines_.next_keyword()) read_section();
  lines_.need_whole_data();
  if (mesh_.node_tags.empty()) in().refuse(SetupErrorKind::bad_file, "*NODE", "the end of the file");
  const IdTable nodes(mesh_.node_tags, node_lines_, "node", in());
  const IdTable elements(element_ids_, element_lines_, "element", in());
  for (const FileCell& cell : mesh_.cells)
    for (std::size_t a = 0; a < static_cast<std::size_t>(facts(cell.shape).nodes); ++a) {
      NodeId& node = mesh_.cell_nodes[cell.first_node + a];
      const Index found = nodes.find(node);
      if (found < 0)
        refuse_at(in(), cell.location, SetupErrorKind::index_out_of_range, "the id of a node of this file",
                  {"'", node, "' in element ", cell.tag});
      node = static_cast<NodeId>(found);
    }
  add_groups(definitions_.groups, nodes, elements, cells_, in(), mesh_);
  for (Vector3& x : mesh_.positions) x += translation_;
  return std::move(mesh_);
}

/// Other keywords are skipped, with their data.
inline void Parser::read_section() {
  struct Section {
    std::string_view keyword;
    void (Parser::*read)();
  };
  static constexpr std::array<Section, 20> sections{
      {{"NODE", &Parser::read_nodes},         {"ELEMENT", &Parser::read_elements},
       {"NSET", &Parser::read_definition},    {"ELSET", &Parser::read_definition},
       {"SURFACE", &Parser::read_definition}, {"SOLIDSECTION", &Parser::read_definition},
       {"PART", &Parser::change_scope},       {"ENDPART", &Parser::change_scope},
       {"ASSEMBLY", &Parser::change_scope},   {"ENDASSEMBLY", &Parser::change_scope},
       {"INSTANCE", &Parser::change_scope},   {"ENDINSTANCE", &Parser::change_scope},
       {"INCLUDE", &Parser::refuse_include},  {"SYSTEM", &Parser::refuse_generator},
       {"NGEN", &Parser::refuse_generator},   {"NFILL", &Parser::refuse_generator},
       {"NCOPY", &Parser::refuse_generator},  {"NMAP", &Parser::refuse_generator},
       {"ELGEN", &Parser::refuse_generator},  {"ELCOPY", &Parser::refuse_generator}}};
  for (const Section& section : sections)
    if (section.keyword == lines_.keyword) return (this->*section.read)();
}

inline void Parser::read_definition() {
  definitions_.in_assembly = scope_ == Scope::assembly;
  if (lines_.keyword == "NSET") return definitions_.read_node_set();
  if (lines_.keyword == "ELSET") return definitions_.read_element_set();
  if (lines_.keyword == "SURFACE") return definitions_.read_surface();
  definitions_.read_solid_section();
}

PALPATE_COLD inline void Parser::refuse_include() {
  lines_.refuse_keyword("a file in one piece",
                        "Insert the included file in its place, or read it alone if it is the mesh");
}

PALPATE_COLD inline void Parser::refuse_generator() {
  lines_.refuse_keyword("nodes and elements in the file",
                        "Write the mesh from a pre-processor: a line for each of them");
}

PALPATE_COLD inline void Parser::change_scope() {
  const std::string& k = lines_.keyword;
  constexpr std::string_view merge = "Merge the instances into one part: in Abaqus/CAE, Instance > Merge/Cut";
  if (k == "PART") {
    if (std::exchange(has_part_, true)) lines_.refuse_keyword("one part", merge);
    scope_ = Scope::part;
  } else if (k == "INSTANCE") {
    if (std::exchange(has_instance_, true)) lines_.refuse_keyword("one instance", merge);
    read_instance();
    scope_ = Scope::instance;
  } else {
    scope_ = k == "ASSEMBLY" || k == "ENDINSTANCE" ? Scope::assembly : Scope::model;
  }
}

/// Data: a translation, then a rotation.
PALPATE_COLD inline void Parser::read_instance() {
  lines_.read_parameters();
  definitions_.instance = upper(lines_.need_value("NAME"));
  if (!lines_.next_data()) return;
  for (int c = 0; c < 3; ++c) translation_[c] = coordinate();
  in().end_line("a translation");
  if (!lines_.next_data()) return;
  double last = 0.0;
  while (!in().rest().empty()) last = coordinate();
  if (last != 0.0) lines_.refuse_keyword("an instance that is not rotated", "Rotate the part instead of the instance");
}

/// A missing coordinate is zero.
inline double Parser::coordinate() {
  if (in().rest().empty()) return 0.0;
  if (in().rest().front() != ',') return in().real("a coordinate");
  in().token();
  return 0.0;
}

inline void Parser::read_nodes() {
  lines_.read_parameters();
  const std::string_view system = lines_.value("SYSTEM");
  if ((!system.empty() && upper(system) != "R") || lines_.has("INPUT"))
    lines_.refuse_keyword("rectangular coordinates in the file", "Write the mesh from a pre-processor");
  const std::size_t first = mesh_.positions.size();
  while (lines_.next_data()) {
    if (scope_ == Scope::assembly) continue;
    node_lines_.push_back(in().location());
    mesh_.node_tags.push_back(in().integer("a node id", 1, max_int));
    Vector3 x;
    for (int c = 0; c < 3; ++c) x[c] = coordinate();
    in().end_line("a node");
    mesh_.positions.push_back(x);
  }
  if (lines_.value("NSET").empty() || scope_ == Scope::assembly) return;
  definitions_.groups.nodes.open(lines_.need_value("NSET"), false);
  definitions_.groups.nodes.add_positions(first, mesh_.positions.size());
}

inline void Parser::read_elements() {
  lines_.read_parameters();
  const std::string name = upper(lines_.need_value("TYPE"));
  const ElementType* type = find_type(name);
  const bool is_skipped = type == nullptr && abaqus::is_skipped(name);
  if (type == nullptr && !is_skipped && scope_ != Scope::assembly)
    in().refuse(SetupErrorKind::unsupported, "a known element type such as C3D4", in_quotes(name),
                "Mesh with C3D4, C3D10, C3D8 or C3D20, and remove the elements of other types");
  if (lines_.has("INPUT"))
    lines_.refuse_keyword("elements in the file", "Insert the file with the elements in its place");
  const std::size_t first = element_ids_.size();
  if (is_skipped || scope_ == Scope::assembly) {
    skip_elements();
  } else {
    while (lines_.next_data()) {
      const Index line = in().location(), id = in().integer("an element id", 1, max_int);
      for (int a = 0; a < facts(type->shape).nodes; ++a) {
        lines_.need_field("a node id");
        mesh_.cell_nodes.push_back(static_cast<NodeId>(in().integer("a node id", 1, max_int)));
      }
      in().end_line("an element");
      element_ids_.push_back(id);
      element_lines_.push_back(line);
      cells_.push_back(static_cast<Index>(mesh_.cells.size()));
      mesh_.add_cell(id, line, type->shape, 0, {});
    }
  }
  if (lines_.value("ELSET").empty() || scope_ == Scope::assembly) return;
  const std::string set = lines_.need_value("ELSET");
  definitions_.groups.elements.open(set, false);
  definitions_.groups.elements.add_positions(first, element_ids_.size());
  if (!is_skipped && facts(type->shape).dimension == 3)
    definitions_.groups.element_blocks.push_back(definitions_.groups.elements.find(set, false));
}

/// Elements of unknown shape, so of an unknown number of nodes: an element continues after a comma at the end of a
/// line.
inline void Parser::skip_elements() {
  bool continues = false;
  while (lines_.next_data()) {
    if (!continues && scope_ != Scope::assembly) {
      element_lines_.push_back(in().location());
      element_ids_.push_back(in().integer("an element id", 1, max_int));
      cells_.push_back(-1);
    }
    continues = in().line().ends_with(',');
  }
}

}  // namespace detail

PALPATE_INLINE FileMesh parse(std::string_view text, const std::string& name) {
  return detail::Parser(text, name).parse();
}

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
