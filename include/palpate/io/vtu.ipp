// Definitions of vtu.hpp.
#pragma once

#include <palpate/io/detail/message.hpp>
#include <palpate/io/detail/vtk_cells.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/vtu.hpp>

#include <bit>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

namespace vtk {

PALPATE_INLINE std::string escape(std::string_view text) {
  std::string out;
  for (const char c : text) {
    if (c == '&')
      out += "&amp;";
    else if (c == '<')
      out += "&lt;";
    else if (c == '>')
      out += "&gt;";
    else if (c == '"')
      out += "&quot;";
    else
      out += c;
  }
  return out;
}

namespace detail {

/// A VTU file under construction: an XML header and raw blocks, to which the header refers by offset.
struct VtuText {
  /// Adds a <DataArray> and its block: the length in bytes as UInt64, then the numbers as they are in memory.
  void array(std::string_view type, std::string_view name, Index components, const void* values, std::size_t bytes);

  /// Adds the fields of `count` nodes or elements; refuses a length that is not a multiple of it.
  void fields(const std::vector<VtuField>& all, Index count);

  void cells(const MeshRef& mesh);
  void regions(const MeshRef& mesh);

  std::string xml, raw;
};

inline void VtuText::array(std::string_view type, std::string_view name, Index components, const void* values,
                           std::size_t bytes) {
  append(xml, {"        <DataArray type=\"", type, "\" Name=\"", escape(name), "\" NumberOfComponents=\"", components,
               "\" format=\"appended\" offset=\"", raw.size(), "\"/>\n"});
  const std::uint64_t length = bytes;
  raw.append(reinterpret_cast<const char*>(&length), sizeof length);
  if (bytes > 0) raw.append(static_cast<const char*>(values), bytes);
}

inline void VtuText::fields(const std::vector<VtuField>& all, Index count) {
  const Index places = count > 0 ? count : 1;
  for (const VtuField& f : all) {
    const Index size = f.values.size();
    if (size % places != 0 || (size == 0) != (count == 0))
      refuse(SetupErrorKind::bad_argument, {"field '", f.name, "' holds ", size, " numbers for ", count, " places"},
             "It needs one or more components for each");
    array("Float64", f.name, size / places, f.values.data(), static_cast<std::size_t>(size) * sizeof(double));
  }
}

inline void VtuText::cells(const MeshRef& mesh) {
  const auto count = static_cast<std::size_t>(mesh.element_count);
  const std::vector<int> order = vtk_order(mesh.element);
  std::vector<std::int64_t> nodes, offsets;
  nodes.reserve(count * order.size());
  offsets.reserve(count);
  for (Index e = 0; e < mesh.element_count; ++e) {
    for (const int a : order) nodes.push_back(mesh.nodes_of(e)[a]);
    offsets.push_back(static_cast<std::int64_t>(nodes.size()));
  }
  const std::string types(count, static_cast<char>(cell_type_of(solid_shape(mesh.element)).number));
  array("Int64", "connectivity", 1, nodes.data(), nodes.size() * sizeof(std::int64_t));
  array("Int64", "offsets", 1, offsets.data(), offsets.size() * sizeof(std::int64_t));
  array("UInt8", "types", 1, types.data(), types.size());
}

inline void VtuText::regions(const MeshRef& mesh) {
  std::vector<std::int32_t> regions;
  regions.reserve(static_cast<std::size_t>(mesh.element_count));
  for (Index e = 0; e < mesh.element_count; ++e) regions.push_back(mesh.region(e));
  array("Int32", "region", 1, regions.data(), regions.size() * sizeof(std::int32_t));
}

}  // namespace detail

}  // namespace vtk

PALPATE_INLINE void write_vtu(const std::string& path, const MeshRef& mesh, const VtuFields& fields) {
  vtk::detail::VtuText file;
  file.xml = joined({"<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"",
                     std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian",
                     "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"", mesh.node_count,
                     "\" NumberOfCells=\"", mesh.element_count, "\">\n      <PointData>\n"});
  file.fields(fields.at_nodes, mesh.node_count);
  file.xml += "      </PointData>\n      <CellData>\n";
  file.regions(mesh);
  file.fields(fields.at_elements, mesh.element_count);
  file.xml += "      </CellData>\n      <Points>\n";
  file.array("Float64", "Points", 3, mesh.positions, static_cast<std::size_t>(mesh.node_count) * 3 * sizeof(double));
  file.xml += "      </Points>\n      <Cells>\n";
  file.cells(mesh);
  file.xml += "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_";
  write_file(path, {file.xml, file.raw, "\n  </AppendedData>\n</VTKFile>\n"});
}

}}}  // namespace palpate::PALPATE_ABI::io
