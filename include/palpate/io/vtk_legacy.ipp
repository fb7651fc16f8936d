// Definitions of read_mesh.hpp: reads legacy VTK files.
#pragma once

#include <palpate/io/detail/vtk_attributes.hpp>
#include <palpate/io/detail/vtk_cells.hpp>
#include <palpate/io/read_mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::vtk {

namespace detail {

/// Parses one file ("VTK File Formats" of the VTK User's Guide; the layout of CELLS changed with 5.0).
class LegacyParser {
 public:
  LegacyParser(std::string_view text, const std::string& name, std::string_view labels)
      : in_(text, name), numbers_(in_), attributes_(in_, numbers_, labels), mesh_(name) {}

  FileMesh parse();

 private:
  void read_head();

  void read_section();

  void once(bool& seen, bool in_place, std::string_view order);

  void read_points();

  void add_node(const NumberType& type);

  /// `CELLS cells numbers`, then `count nodes...` each; since version 5 OFFSETS and CONNECTIVITY.
  void read_cells();

  const NumberType& read_array_head(std::string_view keyword);

  void read_offsets();

  Index cell_count() const noexcept { return static_cast<Index>(cells_.places.size()); }

  void read_types();

  TextReader in_;
  NumberStream numbers_;
  AttributeReader attributes_;
  FileMesh mesh_;
  double version_ = 0.0;
  bool has_points_ = false, has_cells_ = false, has_types_ = false;
  Cells cells_;
};

inline FileMesh LegacyParser::parse() {
  read_head();
  while (in_.next_line()) read_section();
  if (!has_types_) in_.refuse(SetupErrorKind::bad_file, "POINTS, CELLS and CELL_TYPES", "the end of the file");
  if (!numbers_.is_binary) in_.need_last_line_end();
  attributes_.end(mesh_);
  add_cells(cells_, attributes_.regions, mesh_);
  return std::move(mesh_);
}

PALPATE_COLD inline void LegacyParser::read_head() {
  constexpr std::string_view head = "# vtk DataFile Version";
  if (!in_.next_raw_line() || !in_.line().starts_with(head))
    in_.refuse(SetupErrorKind::bad_file, head, in_quotes(in_.line()));
  for (int i = 0; i < 4; ++i) in_.token();
  version_ = in_.real("a version number");
  if (!(version_ >= 1.0 && version_ < 6.0)) in_.refuse(SetupErrorKind::unsupported, "version 1 to 5", version_);
  in_.next_raw_line();  // the title, possibly blank
  in_.need_line("ASCII or BINARY");
  const std::string_view coding = in_.line();
  numbers_.is_binary = same_word(coding, "binary");
  if (!numbers_.is_binary && !same_word(coding, "ascii"))
    in_.refuse(SetupErrorKind::bad_file, "ASCII or BINARY", in_quotes(in_.line()));
  in_.need_line("DATASET UNSTRUCTURED_GRID");
  const bool is_dataset = same_word(in_.token(), "dataset");
  const std::string_view kind = in_.token();
  if (!is_dataset) in_.refuse(SetupErrorKind::bad_file, "DATASET UNSTRUCTURED_GRID", in_quotes(in_.line()));
  if (same_word(kind, "polydata"))
    in_.refuse(SetupErrorKind::unsupported, "solid elements", "a surface (POLYDATA)", fill_command(in_.name()));
  if (!same_word(kind, "unstructured_grid"))
    in_.refuse(SetupErrorKind::unsupported, "UNSTRUCTURED_GRID", in_quotes(lower(kind)),
               {"Convert it: ", meshio_command(in_.name())});
}

inline void LegacyParser::read_section() {
  const std::string_view keyword = in_.token();
  if (same_word(keyword, "points")) {
    read_points();
  } else if (same_word(keyword, "cells")) {
    read_cells();
  } else if (same_word(keyword, "cell_types")) {
    read_types();
  } else if (same_word(keyword, "cell_data") || same_word(keyword, "point_data")) {
    if (!has_types_) in_.refuse(SetupErrorKind::bad_file, "CELL_TYPES before data", in_quotes(in_.line()));
    const bool of_cells = same_word(keyword, "cell_data");
    attributes_.begin(of_cells, of_cells ? cell_count() : static_cast<Index>(mesh_.positions.size()));
  } else {
    attributes_.read(keyword);
  }
}

PALPATE_COLD inline void LegacyParser::once(bool& seen, bool in_place, std::string_view order) {
  if (seen) in_.refuse(SetupErrorKind::bad_file, "every section once", {in_quotes(in_.line()), " again"});
  if (!in_place) in_.refuse(SetupErrorKind::bad_file, order, in_quotes(in_.line()));
  seen = true;
}

inline void LegacyParser::read_points() {
  once(has_points_, true, {});
  const Index count = numbers_.count("a number of points", 3);
  const NumberType& type = numbers_.read_type();
  in_.end_line("the number of points");
  if (type.kind == NumberType::text || type.bits == 1)
    in_.refuse(SetupErrorKind::bad_file, "points of a type of numbers such as double", type.name);
  mesh_.positions.reserve(static_cast<std::size_t>(count));
  for (Index i = 0; i < count; ++i) {
    Vector3 x;
    for (int c = 0; c < 3; ++c) x[c] = numbers_.real(type, "a coordinate");
    mesh_.node_tags.push_back(i);
    mesh_.positions.push_back(x);
  }
  numbers_.end("the points");
}

inline void LegacyParser::add_node(const NumberType& type) {
  const Index last = static_cast<Index>(mesh_.positions.size()) - 1;
  mesh_.cell_nodes.push_back(static_cast<NodeId>(numbers_.integer(type, "a node", 0, last)));
}

inline void LegacyParser::read_cells() {
  once(has_cells_, has_points_, "POINTS before CELLS");
  if (version_ >= 5.0) return read_offsets();
  const Index count = numbers_.count("a number of cells", 2), total = numbers_.count("a number of numbers", 1);
  in_.end_line("the number of numbers");
  const NumberType& type = number_types[7];
  cells_.offsets.assign(1, 0);
  for (Index c = 0, left = total; c < count; ++c) {
    if (!numbers_.is_binary) in_.need_more("a cell");
    cells_.places.push_back(in_.location());
    const Index nodes = numbers_.integer(type, "a number of nodes of a cell", 0, max_int);
    if (nodes >= left)
      in_.refuse(SetupErrorKind::index_out_of_range, {total, " numbers in CELLS"},
                 {"a cell of ", nodes, " nodes after ", total - left, " numbers"});
    for (Index a = 0; a < nodes; ++a) add_node(type);
    cells_.offsets.push_back(static_cast<Index>(mesh_.cell_nodes.size()));
    left -= nodes + 1;
  }
  numbers_.end("the cells");
  if (const Index found = cells_.offsets.back() + count; found != total)
    in_.refuse(SetupErrorKind::bad_file, {total, " numbers in CELLS"}, {found});
}

PALPATE_COLD inline const NumberType& LegacyParser::read_array_head(std::string_view keyword) {
  in_.need_line(keyword);
  if (!same_word(in_.token(), keyword)) in_.refuse(SetupErrorKind::bad_file, keyword, in_quotes(in_.line()));
  const NumberType& type = numbers_.read_type();
  in_.end_line(keyword);
  if (type.kind == NumberType::real || type.kind == NumberType::text || type.bits == 1)
    in_.refuse(SetupErrorKind::bad_file, "a type of integers", type.name);
  return type;
}

inline void LegacyParser::read_offsets() {
  const Index count = numbers_.count("a number of offsets", 1), total = numbers_.count("a number of nodes", 1);
  in_.end_line("the number of nodes");
  const NumberType& offset_type = read_array_head("OFFSETS");
  for (Index i = 0; i < count; ++i)
    cells_.offsets.push_back(
        numbers_.integer(offset_type, "an offset", i == 0 ? 0 : cells_.offsets.back(), i == 0 ? 0 : total));
  numbers_.end("the offsets");
  if (count > 0 && cells_.offsets.back() != total)
    in_.refuse(SetupErrorKind::bad_file, {"a last offset of ", total}, {cells_.offsets.back()});
  if (count == 0) cells_.offsets.assign(1, 0);
  const NumberType& node_type = read_array_head("CONNECTIVITY");
  for (std::size_t c = 1; c < cells_.offsets.size(); ++c) {
    if (!numbers_.is_binary && cells_.offsets[c] > cells_.offsets[c - 1]) in_.need_more("a node");
    cells_.places.push_back(in_.location());
    for (Index a = cells_.offsets[c - 1]; a < cells_.offsets[c]; ++a) add_node(node_type);
  }
  numbers_.end("the nodes of the cells");
}

inline void LegacyParser::read_types() {
  once(has_types_, has_cells_, "CELLS before CELL_TYPES");
  const Index count = in_.integer("a number of cells", cell_count(), cell_count(), SetupErrorKind::bad_file);
  in_.end_line("the number of cells");
  for (Index c = 0; c < count; ++c) {
    add_type(cells_, numbers_.integer(number_types[7], "a cell type", 0, 255), in_);
  }
  numbers_.end("the cell types");
}

}  // namespace detail

PALPATE_INLINE FileMesh parse(std::string_view text, const std::string& name, std::string_view labels) {
  return detail::LegacyParser(text, name, labels).parse();
}

}}}  // namespace palpate::PALPATE_ABI::io::vtk
