// Reads VTU files (unstructured grids of VTK in XML): text, base64 and raw data, as it is or compressed by zlib.
#pragma once

#include <palpate/io/detail/vtk_attributes.hpp>
#include <palpate/io/detail/vtk_cells.hpp>
#include <palpate/io/file_mesh.hpp>
#include <palpate/io/xml/detail/vtu_arrays.hpp>

#include <algorithm>
#include <bit>

namespace palpate { inline namespace PALPATE_ABI { namespace io::xml {

/// Reads a whole file with one `<Piece>`, of either byte order. Cells and regions are read as from legacy files, with
/// `labels` the name of the array of regions, see vtk::parse. The compressors LZ4 and LZMA are refused, as are
/// several pieces.
///
/// Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, with file and line, in binary data
/// with the byte of the array. Linear in the size of the data. Sizes in the file are compared with the sizes that its
/// points and cells need before anything is allocated; compressed data may grow by `most_expansion`.
FileMesh parse_vtu(std::string_view text, const std::string& name, std::string_view labels = {});

namespace detail {

/// Parses one file ("VTK File Formats", XML; `<AppendedData>` may contain any bytes and is cut off before).
class VtuParser {
 public:
  VtuParser(std::string_view text, const std::string& name, std::string_view labels, std::size_t appended)
      : document_(text.substr(0, appended), name, {}, appended < text.size() ? "</VTKFile>" : ""),
        mesh_(name),
        labels_(labels),
        bytes_(document_, coding(text, appended)) {}

  FileMesh parse();

 private:
  VtuCoding coding(std::string_view text, std::size_t appended);
  void read_appended(std::string_view text, VtuCoding& coding);
  pugi::xml_node need_piece();
  void read_points(pugi::xml_node points);
  void read_cells(pugi::xml_node cells);
  void read_regions(pugi::xml_node data);
  bool take_regions(pugi::xml_node array);
  void note_labels(pugi::xml_node data);
  static bool has_number_per_cell(pugi::xml_node array);
  pugi::xml_node named_array(pugi::xml_node parent, std::string_view name);

  Document document_;
  FileMesh mesh_;
  std::string_view labels_;
  VtuBytes bytes_;
  Index points_ = 0, cell_count_ = 0;
  vtk::Cells cells_;
  std::vector<int> regions_;
};

inline VtuCoding VtuParser::coding(std::string_view text, std::size_t appended) {
  const pugi::xml_node file = document_.root();
  const std::string_view type = file.attribute("type").value(), order = file.attribute("byte_order").value();
  const std::string_view compressor = file.attribute("compressor").value(),
                         head = file.attribute("header_type").value();
  if (std::string_view(file.name()) != "VTKFile")
    document_.refuse(file, SetupErrorKind::bad_file, "<VTKFile>", in_quotes(file.name()));
  if (type == "PolyData")
    document_.refuse(file, SetupErrorKind::unsupported, "solid elements", "a surface (PolyData)",
                     fill_command(mesh_.files[0]));
  if (type != "UnstructuredGrid")
    document_.refuse(file, SetupErrorKind::unsupported, "UnstructuredGrid", in_quotes(type),
                     "Save it as one .vtu file, in ParaView after Append Datasets");
  if (!compressor.empty() && compressor != "vtkZLibDataCompressor")
    document_.refuse(file, SetupErrorKind::unsupported, "data compressed by zlib", in_quotes(compressor),
                     "Save it with the compressor ZLib or none");
  if (!head.empty() && head != "UInt32" && head != "UInt64")
    document_.refuse(file, SetupErrorKind::unsupported, "the header_type UInt32 or UInt64", in_quotes(head));
  if (!order.empty() && order != "LittleEndian" && order != "BigEndian")
    document_.refuse(file, SetupErrorKind::bad_file, "LittleEndian or BigEndian", in_quotes(order));
  VtuCoding c;
  c.is_swapped = (order == "BigEndian") != (std::endian::native == std::endian::big);
  c.is_compressed = !compressor.empty();
  c.header_bytes = head == "UInt64" ? 8 : 4;
  c.file_size = text.size();
  if (appended < text.size()) read_appended(text.substr(appended), c);
  return c;
}

/// `text` begins with <AppendedData.
inline void VtuParser::read_appended(std::string_view text, VtuCoding& coding) {
  const std::size_t end = std::min(text.find('>'), text.size()), mark = text.find('_', end);
  const std::string_view head = text.substr(0, end);
  coding.appended_is_base64 = head.find("\"base64\"") != head.npos || head.find("'base64'") != head.npos;
  const bool is_raw = head.find("\"raw\"") != head.npos || head.find("'raw'") != head.npos;
  if (mark == text.npos || (!is_raw && !coding.appended_is_base64))
    document_.refuse(document_.root(), SetupErrorKind::bad_file, "<AppendedData> in raw or base64 encoding after _",
                     in_quotes(head));
  coding.appended = text.substr(mark + 1);
  // The end mark, which is no data; raw data may contain the same bytes, so the last one counts.
  const std::size_t close = coding.appended.rfind("</AppendedData");
  if (close == coding.appended.npos)
    document_.refuse(document_.root(), SetupErrorKind::bad_file, "</AppendedData>", "the end of the file");
  coding.appended = coding.appended.substr(0, close);
}

inline FileMesh VtuParser::parse() {
  const pugi::xml_node piece = need_piece();
  points_ = document_.integer(piece, "NumberOfPoints", 0, max_int, SetupErrorKind::count_too_large);
  cell_count_ = document_.integer(piece, "NumberOfCells", 0, max_int, SetupErrorKind::count_too_large);
  read_points(document_.need_child(piece, "Points"));
  read_cells(document_.need_child(piece, "Cells"));
  read_regions(piece.child("CellData"));
  vtk::add_cells(cells_, regions_, mesh_);
  return std::move(mesh_);
}

inline pugi::xml_node VtuParser::need_piece() {
  const pugi::xml_node grid = document_.need_child(document_.root(), "UnstructuredGrid");
  const pugi::xml_node piece = document_.need_child(grid, "Piece");
  return piece;
}

inline void VtuParser::read_points(pugi::xml_node points) {
  const pugi::xml_node array = document_.need_child(points, "DataArray");
  if (array.attribute("NumberOfComponents")) document_.integer(array, "NumberOfComponents", 3, 3);
  VtuArray numbers(document_, bytes_, array, 3 * points_);
  for (Index i = 0; i < points_; ++i) {
    Vector3 x;
    for (int c = 0; c < 3; ++c) x[c] = numbers.real("a coordinate");
    mesh_.node_tags.push_back(i);
    mesh_.positions.push_back(x);
  }
  numbers.end();
}

inline pugi::xml_node VtuParser::named_array(pugi::xml_node parent, std::string_view name) {
  for (const pugi::xml_node array : parent.children("DataArray"))
    if (array.attribute("Name").value() == name) return array;
  document_.refuse(parent, SetupErrorKind::bad_file, {"an array ", name, " in <", parent.name(), ">"}, "none");
}

inline void VtuParser::read_cells(pugi::xml_node cells) {
  VtuArray offsets(document_, bytes_, named_array(cells, "offsets"), cell_count_);
  cells_.offsets.push_back(0);
  for (Index c = 0; c < cell_count_; ++c)
    cells_.offsets.push_back(offsets.integer("an offset", cells_.offsets.back(), Index{1} << 48));
  offsets.end();
  VtuArray nodes(document_, bytes_, named_array(cells, "connectivity"), cells_.offsets.back());
  for (Index c = 1; c <= cell_count_; ++c) {
    const auto at = static_cast<std::size_t>(c);
    cells_.places.push_back(nodes.line());
    for (Index a = cells_.offsets[at - 1]; a < cells_.offsets[at]; ++a)
      mesh_.cell_nodes.push_back(static_cast<NodeId>(nodes.integer("a node", 0, points_ - 1)));
  }
  nodes.end();
  VtuArray types(document_, bytes_, named_array(cells, "types"), cell_count_);
  for (Index c = 0; c < cell_count_; ++c) vtk::add_type(cells_, types.integer("a cell type", 0, 255), types.in());
  types.end();
}

inline bool VtuParser::has_number_per_cell(pugi::xml_node array) {
  const std::string_view components = array.attribute("NumberOfComponents").value();
  return components.empty() || components == "1";
}

/// The first array in the order of preference of legacy files.
inline void VtuParser::read_regions(pugi::xml_node data) {
  std::string found;
  for (const std::string_view name : vtk::region_names(labels_))
    for (const pugi::xml_node array : data.children("DataArray"))
      if (regions_.empty() && array.attribute("Name").value() == name && has_number_per_cell(array) &&
          take_regions(array))
        return note_labels(data);
  if (labels_.empty()) return note_labels(data);
  for (const pugi::xml_node array : data.children("DataArray"))
    if (found.size() < 200) append(found, {found.empty() ? "'" : ", '", array.attribute("Name").value(), "'"});
  refuse(SetupErrorKind::bad_argument,
         {mesh_.files[0], ": expected an array ", in_quotes(labels_), " with a number per cell, found ",
          found.empty() ? std::string_view("none") : std::string_view(found)});
}

/// False for real numbers that are not whole.
inline bool VtuParser::take_regions(pugi::xml_node array) {
  const bool is_real = VtuArray::type_of(document_, array).kind == vtk::NumberType::real;
  VtuArray numbers(document_, bytes_, array, cell_count_);
  std::vector<int> read;
  for (Index c = 0; c < cell_count_; ++c) {
    if (!is_real) {
      read.push_back(static_cast<int>(numbers.integer("a region number", -max_int, max_int)));
      continue;
    }
    const double number = numbers.any_number();
    if (!is_label(number) && !labels_.empty())
      document_.refuse(array, SetupErrorKind::bad_argument, {"whole numbers in the array '", labels_, "'"}, number);
    if (!is_label(number)) return false;
    read.push_back(static_cast<int>(number));
  }
  numbers.end();
  regions_.swap(read);
  return true;
}

/// Only a few arrays, so that the bound of decompressed data is not reached by arrays that are not used.
inline void VtuParser::note_labels(pugi::xml_node data) {
  if (!labels_.empty() || vtk::has_regions(regions_)) return;
  std::vector<UnusedLabels> unused;
  int tried = 0;
  for (const pugi::xml_node array : data.children("DataArray")) {
    const std::string_view name = array.attribute("Name").value();
    const bool is_readable = VtuArray::find_type(array) != nullptr && array.attribute("format");
    if (!is_readable || !has_number_per_cell(array) || !vtk::may_be_unknown(name) || ++tried > 10) continue;
    VtuArray numbers(document_, bytes_, array, cell_count_);
    LabelCount labels;
    for (Index c = 0; c < cell_count_; ++c) labels.add(numbers.any_number());
    if (labels.looks_like_labels()) unused.push_back({std::string(name), labels.different()});
  }
  note_unused_labels(unused, mesh_);
}

}  // namespace detail

inline FileMesh parse_vtu(std::string_view text, const std::string& name, std::string_view labels) {
  return detail::VtuParser(text, name, labels, std::min(text.find("<AppendedData"), text.size())).parse();
}

}}}  // namespace palpate::PALPATE_ABI::io::xml
