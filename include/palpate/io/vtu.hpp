// Writes meshes with fields for ParaView and other readers of VTK files.
#pragma once

#include <palpate/io/decimal.hpp>
#include <palpate/io/file.hpp>
#include <palpate/io/vtk_types.hpp>
#include <palpate/mesh/mesh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// A field to write: `values` holds the components of node or element 0, then of 1, and so on. How many components
/// there are follows from the length: 1 is a scalar, 3 a vector such as a displacement.
struct VtuField {
  std::string name;
  VectorX values;
};

/// The fields of a file; either list may be empty.
struct VtuFields {
  std::vector<VtuField> at_nodes;
  std::vector<VtuField> at_elements;
};

namespace vtk {

/// `text` with the characters that XML keeps for itself spelled out.
inline std::string escape(std::string_view text) {
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

/// A VTU file in the making: an XML head and raw blocks, to which the head refers by offset.
class VtuText {
 public:
  /// Adds a <DataArray> and its block: the length in bytes as UInt64, then the numbers as they are in memory.
  template <class T>
  void array(const std::string& type, std::string_view name, Index components, const T* values, std::size_t count) {
    xml += "        <DataArray type=\"" + type + "\" Name=\"" + escape(name) + "\" NumberOfComponents=\"" +
           std::to_string(components) + "\" format=\"appended\" offset=\"" + std::to_string(raw.size()) + "\"/>\n";
    const std::uint64_t bytes = count * sizeof(T);
    raw.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    raw.append(reinterpret_cast<const char*>(values), static_cast<std::size_t>(bytes));
  }

  /// Adds the fields of `count` nodes or elements; refuses a length that is no multiple of it.
  void fields(const std::vector<VtuField>& all, Index count) {
    for (const VtuField& f : all) {
      if (f.values.size() % std::max<Index>(count, 1) != 0 || (f.values.size() == 0) != (count == 0))
        raise(SetupErrorKind::bad_argument,
              "field '" + f.name + "' holds " + std::to_string(f.values.size()) + " numbers for " +
                  std::to_string(count) + " places",
              "It needs one or more components for each");
      array("Float64", f.name, f.values.size() / std::max<Index>(count, 1), f.values.data(),
            static_cast<std::size_t>(f.values.size()));
    }
  }

  std::string xml, raw;
};

template <Element E, MeshOf<E> M>
void add_points(VtuText& file, const M& mesh) {
  std::vector<double> x;
  x.reserve(3 * static_cast<std::size_t>(mesh.node_count()));
  for (Index i = 0; i < mesh.node_count(); ++i)
    for (int c = 0; c < 3; ++c) x.push_back(mesh.position(i)[c]);
  file.array("Float64", "Points", 3, x.data(), x.size());
}

template <Element E, MeshOf<E> M>
void add_cells(VtuText& file, const M& mesh) {
  const auto count = static_cast<std::size_t>(mesh.element_count());
  const auto order = vtk_order<E>();
  constexpr int type = std::ranges::find(cell_types, solid_shape<E>(), &CellType::shape)->number;
  std::vector<std::int64_t> nodes, offsets;
  nodes.reserve(count * static_cast<std::size_t>(E::nodes));
  offsets.reserve(count);
  for (Index e = 0; e < mesh.element_count(); ++e) {
    for (const int a : order) nodes.push_back(static_cast<std::int64_t>(mesh.element_node(e, a)));
    offsets.push_back(static_cast<std::int64_t>(nodes.size()));
  }
  const std::vector<std::uint8_t> types(count, static_cast<std::uint8_t>(type));
  file.array("Int64", "connectivity", 1, nodes.data(), nodes.size());
  file.array("Int64", "offsets", 1, offsets.data(), offsets.size());
  file.array("UInt8", "types", 1, types.data(), types.size());
}

template <Element E, MeshOf<E> M>
void add_regions(VtuText& file, const M& mesh) {
  std::vector<std::int32_t> regions;
  for (Index e = 0; e < mesh.element_count(); ++e) regions.push_back(static_cast<std::int32_t>(mesh.region(e)));
  file.array("Int32", "region", 1, regions.data(), regions.size());
}

}  // namespace vtk

/// Writes a mesh and fields on it as a VTU file (raw appended data, 64-bit lengths). Positions are those at rest [m];
/// ParaView's "Warp By Vector" adds a displacement. The region numbers come along as the element field "region". NaN
/// and infinity are written as they are. Throws bad_file when the file cannot be written and bad_argument when a field
/// has the wrong length; then no file is begun. Needs memory for one copy of the file.
template <Element E, MeshOf<E> M>
void write_vtu(const std::string& path, const M& mesh, const VtuFields& fields = {}) {
  vtk::VtuText file;
  const std::string endian = std::endian::native == std::endian::little ? "LittleEndian" : "BigEndian";
  file.xml = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"1.0\" byte_order=\"" + endian +
             "\" header_type=\"UInt64\">\n  <UnstructuredGrid>\n    <Piece NumberOfPoints=\"" +
             std::to_string(mesh.node_count()) + "\" NumberOfCells=\"" + std::to_string(mesh.element_count()) + "\">\n";
  file.xml += "      <PointData>\n";
  file.fields(fields.at_nodes, mesh.node_count());
  file.xml += "      </PointData>\n      <CellData>\n";
  vtk::add_regions<E>(file, mesh);
  file.fields(fields.at_elements, mesh.element_count());
  file.xml += "      </CellData>\n      <Points>\n";
  vtk::add_points<E>(file, mesh);
  file.xml += "      </Points>\n      <Cells>\n";
  vtk::add_cells<E>(file, mesh);
  file.xml += "      </Cells>\n    </Piece>\n  </UnstructuredGrid>\n  <AppendedData encoding=\"raw\">\n_";
  write_file(path, {file.xml, file.raw, "\n  </AppendedData>\n</VTKFile>\n"});
}

/// The same for a Mesh, which knows its element.
template <Element E>
void write_vtu(const std::string& path, const Mesh<E>& mesh, const VtuFields& fields = {}) {
  write_vtu<E, Mesh<E>>(path, mesh, fields);
}

}}}  // namespace palpate::io
