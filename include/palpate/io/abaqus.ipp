// Definitions of abaqus.hpp.
#pragma once

#include <palpate/io/abaqus.hpp>
#include <palpate/io/detail/abaqus_definitions.hpp>
#include <palpate/io/detail/abaqus_types.hpp>

#include <array>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

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
        refuse_at(in(), cell.place, SetupErrorKind::index_out_of_range, "the id of a node of this file",
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
    node_lines_.push_back(in().place());
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
      const Index line = in().place(), id = in().integer("an element id", 1, max_int);
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
      element_lines_.push_back(in().place());
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
