// Writes a parsed file in every supported format: small writers, independent of the readers.
#pragma once

#include <palpate/io/file_mesh.hpp>
#include <palpate/io/decimal.hpp>

#include <bit>
#include <cstring>
#include <map>

namespace test {

using palpate::Index;
using palpate::io::CellShape;
using palpate::io::facts;
using palpate::io::FileCell;
using palpate::io::FileMesh;

/// The bytes of a number, in reversed order if `swap`.
template <class T>
std::string bytes(T value, bool swap) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  return swap ? std::string(raw.rbegin(), raw.rend()) : raw;
}
inline std::string i32(Index value, bool swap = false) {
  return bytes(static_cast<std::int32_t>(value), swap);
}
inline std::string i64(Index value, bool swap = false) {
  return bytes(static_cast<std::int64_t>(value), swap);
}
inline std::string f64(double value, bool swap = false) {
  return bytes(value, swap);
}

inline std::string words(std::initializer_list<Index> numbers) {
  std::string text;
  for (const Index n : numbers) text += (text.empty() ? "" : " ") + std::to_string(n);
  return text;
}
inline std::string point(const palpate::Vector3& x) {
  using palpate::io::to_decimal;
  return to_decimal(x[0]) + ' ' + to_decimal(x[1]) + ' ' + to_decimal(x[2]);
}

inline int tag_of(const FileMesh& m, const FileCell& c) {
  return c.tag_set == 0 ? 0 : m.tag_sets[c.tag_set].front();
}
inline Index node_of(const FileMesh& m, const FileCell& c, int a) {
  return m.cell_nodes[c.first_node + static_cast<std::size_t>(a)];
}
inline std::string node_list(const FileMesh& m, const FileCell& c, Index base) {
  std::string text;
  for (int a = 0; a < facts(c.shape).nodes; ++a) text += ' ' + std::to_string(node_of(m, c, a) + base);
  return text;
}
inline int gmsh_number(CellShape shape) {
  return shape == CellShape::point ? 15 : shape == CellShape::triangle3 ? 2 : 4;
}
inline int vtk_number(CellShape shape) {
  return shape == CellShape::point ? 1 : shape == CellShape::triangle3 ? 5 : 10;
}

inline std::string names_section(const FileMesh& m) {
  if (m.names.empty()) return {};
  std::string text = "$PhysicalNames\n" + std::to_string(m.names.size()) + '\n';
  for (const auto& n : m.names) text += words({n.dimension, n.tag}) + " \"" + n.name + "\"\n";
  return text + "$EndPhysicalNames\n";
}

inline std::string msh1(const FileMesh& m) {
  std::string text = "$NOD\n" + std::to_string(m.positions.size()) + '\n';
  for (std::size_t i = 0; i < m.positions.size(); ++i)
    text += std::to_string(i + 1) + ' ' + point(m.positions[i]) + '\n';
  text += "$ENDNOD\n$ELM\n" + std::to_string(m.cells.size()) + '\n';
  for (const FileCell& c : m.cells)
    text += words({c.tag, gmsh_number(c.shape), tag_of(m, c), 1, facts(c.shape).nodes}) + node_list(m, c, 1) + '\n';
  return text + "$ENDELM\n";
}

inline std::string msh2_binary(const FileMesh& m, bool swap) {
  std::string text = "$MeshFormat\n2.2 1 8\n" + i32(1, swap) + "\n$EndMeshFormat\n" + names_section(m) + "$Nodes\n" +
                     std::to_string(m.positions.size()) + '\n';
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    text += i32(static_cast<Index>(i) + 1, swap);
    for (int k = 0; k < 3; ++k) text += f64(m.positions[i][k], swap);
  }
  text += "\n$EndNodes\n$Elements\n" + std::to_string(m.cells.size()) + '\n';
  for (const FileCell& c : m.cells) {
    for (const Index n : {Index{gmsh_number(c.shape)}, Index{1}, Index{2}, c.tag, Index{tag_of(m, c)}, Index{1}})
      text += i32(n, swap);
    for (int a = 0; a < facts(c.shape).nodes; ++a) text += i32(node_of(m, c, a) + 1, swap);
  }
  return text + "\n$EndElements\n";
}

/// An entity per dimension and tag, numbered tag + 1; cells in blocks of the same entity.
inline std::string msh4_binary(const FileMesh& m, bool swap) {
  std::array<std::map<int, Index>, 4> entities;
  for (const FileCell& c : m.cells) ++entities[static_cast<std::size_t>(facts(c.shape).dimension)][tag_of(m, c)];
  entities[3].try_emplace(0, 0);
  std::string text = "$MeshFormat\n4.1 1 8\n" + i32(1, swap) + "\n$EndMeshFormat\n" + names_section(m) + "$Entities\n";
  for (const auto& of_dimension : entities) text += i64(static_cast<Index>(of_dimension.size()), swap);
  for (std::size_t d = 0; d < 4; ++d)
    for (const auto& [tag, cells] : entities[d]) {
      text += i32(tag + 1, swap);
      for (int k = 0; k < (d == 0 ? 3 : 6); ++k) text += f64(1e300 * 1e10, swap);
      text += i64(tag == 0 ? 0 : 1, swap) + (tag == 0 ? "" : i32(-tag, swap));
      if (d > 0) text += i64(1, swap) + i32(-1, swap);
    }
  const auto n = static_cast<Index>(m.positions.size());
  text += "\n$EndEntities\n$Nodes\n" + i64(1, swap) + i64(n, swap) + i64(1, swap) + i64(n, swap) + i32(3, swap) +
          i32(1, swap) + i32(0, swap) + i64(n, swap);
  for (Index i = 1; i <= n; ++i) text += i64(i, swap);
  for (const auto& x : m.positions)
    for (int k = 0; k < 3; ++k) text += f64(x[k], swap);
  std::string blocks;
  Index count = 0;
  for (std::size_t i = 0, j = 0; i < m.cells.size(); i = j, ++count) {
    const FileCell& first = m.cells[i];
    std::string rows;
    for (; j < m.cells.size() && m.cells[j].shape == first.shape && m.cells[j].tag_set == first.tag_set; ++j) {
      rows += i64(m.cells[j].tag, swap);
      for (int a = 0; a < facts(first.shape).nodes; ++a) rows += i64(node_of(m, m.cells[j], a) + 1, swap);
    }
    blocks += i32(facts(first.shape).dimension, swap) + i32(tag_of(m, first) + 1, swap) +
              i32(gmsh_number(first.shape), swap) + i64(static_cast<Index>(j - i), swap) + rows;
  }
  text += "\n$EndNodes\n$Elements\n" + i64(count, swap) + i64(static_cast<Index>(m.cells.size()), swap) + i64(1, swap) +
          i64(static_cast<Index>(m.cells.size()), swap);
  return text + blocks + "\n$EndElements\n";
}

/// One volume, surface and point entity per tag, numbered tag + 1; a block per cell.
inline std::string msh4_ascii(const FileMesh& m) {
  std::array<std::map<int, Index>, 4> entities;
  for (const FileCell& c : m.cells) ++entities[static_cast<std::size_t>(facts(c.shape).dimension)][tag_of(m, c)];
  const auto sizes = [&](std::size_t d) { return static_cast<Index>(entities[d].size()); };
  std::string text = "$MeshFormat\n4.1 0 8\n$EndMeshFormat\n" + names_section(m) + "$Entities\n" +
                     words({sizes(0), sizes(1), sizes(2), sizes(3)}) + '\n';
  for (std::size_t d = 0; d < 4; ++d)
    for (const auto& [tag, cells] : entities[d]) {
      text += std::to_string(tag + 1) + (d == 0 ? " 0 0 0 " : " 0 0 0 1 1 1 ");
      text += (tag == 0 ? "0" : "1 " + std::to_string(tag)) + (d == 0 ? "\n" : " 0\n");
    }
  const auto n = static_cast<Index>(m.positions.size()), cells = static_cast<Index>(m.cells.size());
  const int home = entities[3].begin()->first + 1;
  text += "$EndEntities\n$Nodes\n" + words({1, n, 1, n}) + '\n' + words({3, home, 0, n}) + '\n';
  for (Index i = 1; i <= n; ++i) text += std::to_string(i) + '\n';
  for (const auto& x : m.positions) text += point(x) + '\n';
  text += "$EndNodes\n$Elements\n" + words({cells, cells, 1, cells}) + '\n';
  for (const FileCell& c : m.cells)
    text += words({facts(c.shape).dimension, tag_of(m, c) + 1, gmsh_number(c.shape), 1}) + '\n' +
            std::to_string(c.tag) + node_list(m, c, 1) + '\n';
  return text + "$EndElements\n";
}

/// The .node, .ele and .face files with the byte 0x1F between them; ids count from `base`.
inline std::string tetgen(const FileMesh& m, Index base) {
  std::map<Index, int> markers;
  std::string ele, face;
  Index elements = 0, faces = 0;
  for (const FileCell& c : m.cells) {
    const std::string tag = std::to_string(tag_of(m, c));
    if (c.shape == CellShape::point) markers[node_of(m, c, 0)] = tag_of(m, c);
    if (c.shape == CellShape::triangle3)
      face += std::to_string(base + faces++) + node_list(m, c, base) + ' ' + tag + '\n';
    if (c.shape == CellShape::tetrahedron4)
      ele += std::to_string(base + elements++) + node_list(m, c, base) + ' ' + tag + '\n';
  }
  std::string node = std::to_string(m.positions.size()) + " 3 0 1\n";
  for (std::size_t i = 0; i < m.positions.size(); ++i)
    node += std::to_string(static_cast<Index>(i) + base) + ' ' + point(m.positions[i]) + ' ' +
            std::to_string(markers[static_cast<Index>(i)]) + '\n';
  return "# nodes\n" + node + '\x1f' + std::to_string(elements) + " 4 1 # tetrahedra\n" + ele + '\x1f' +
         std::to_string(faces) + " 1\n" + face + "# Generated by hand\n";
}

/// Legacy VTK of version 2 or 5.
inline std::string vtk(const FileMesh& m, int version, bool is_binary) {
  const bool swap = std::endian::native == std::endian::little;
  std::string text = "# vtk DataFile Version " + std::string(version == 5 ? "5.1" : "2.0") + "\n\n" +
                     (is_binary ? "BINARY" : "ASCII") + "\nDATASET UNSTRUCTURED_GRID\nPOINTS " +
                     std::to_string(m.positions.size()) + " double\n";
  const auto put = [&](Index n, bool is_long) {
    text += !is_binary ? std::to_string(n) + ' ' : is_long ? i64(n, swap) : i32(n, swap);
  };
  for (const auto& x : m.positions)
    for (int k = 0; k < 3; ++k)
      text += is_binary ? f64(x[k], swap) : palpate::io::to_decimal(x[k]) + (k < 2 ? " " : "\n");
  const auto cells = static_cast<Index>(m.cells.size()), nodes = static_cast<Index>(m.cell_nodes.size());
  if (version == 5) {
    text += "\nCELLS " + words({cells + 1, nodes}) + "\nOFFSETS vtktypeint64\n";
    Index offset = 0;
    put(offset, true);
    for (const FileCell& c : m.cells) put(offset += facts(c.shape).nodes, true);
    text += "\nCONNECTIVITY vtktypeint64\n";
  } else {
    text += "\nCELLS " + words({cells, nodes + cells}) + '\n';
  }
  for (const FileCell& c : m.cells) {
    if (version != 5) put(facts(c.shape).nodes, false);
    for (int a = 0; a < facts(c.shape).nodes; ++a) put(node_of(m, c, a), version == 5);
    if (!is_binary) text += '\n';
  }
  text += "\nCELL_TYPES " + std::to_string(cells) + '\n';
  for (const FileCell& c : m.cells) put(vtk_number(c.shape), false);
  text +=
      "\n\nCELL_DATA " + std::to_string(cells) + "\nFIELD FieldData 1\nregion 1 " + std::to_string(cells) + " int\n";
  for (const FileCell& c : m.cells) put(tag_of(m, c), false);
  return text + "\n";
}

/// VegaFEM: tetrahedra only; every named volume is a set and a region.
inline std::string veg(const FileMesh& m) {
  std::map<int, std::string> sets;
  std::string elements;
  Index count = 0;
  for (const FileCell& c : m.cells)
    if (c.shape == CellShape::tetrahedron4) {
      elements += std::to_string(++count) + node_list(m, c, 1) + '\n';
      sets[tag_of(m, c)] += std::to_string(count) + (count % 8 == 0 ? ",\n" : ", ");
    }
  std::string text = "# VegaFEM\n*VERTICES\n" + std::to_string(m.positions.size()) + " 3 0 0\n";
  for (std::size_t i = 0; i < m.positions.size(); ++i)
    text += std::to_string(i + 1) + ' ' + point(m.positions[i]) + '\n';
  text +=
      "\n*ELEMENTS\nTET\n" + std::to_string(count) + " 4 0\n" + elements + "\n*MATERIAL soft\nENU, 1060, 5e3, 0.45\n";
  for (const auto& n : m.names)
    if (n.dimension == 3) text += "\n*SET " + n.name + '\n' + sets[n.tag] + "\n\n*REGION\n" + n.name + ", soft\n";
  return text;
}

/// Medit as text: references are tags, those of points belong to vertices.
inline std::string medit(const FileMesh& m) {
  std::map<Index, int> references;
  std::map<CellShape, std::string> rows;
  std::map<CellShape, Index> counts;
  for (const FileCell& c : m.cells) {
    if (c.shape == CellShape::point) references[node_of(m, c, 0)] = tag_of(m, c);
    rows[c.shape] += (node_list(m, c, 1) + ' ' + std::to_string(tag_of(m, c))).substr(1) + '\n';
    ++counts[c.shape];
  }
  std::string text = "MeshVersionFormatted 2\nDimension 3\nVertices\n" + std::to_string(m.positions.size()) + '\n';
  for (std::size_t i = 0; i < m.positions.size(); ++i)
    text += point(m.positions[i]) + ' ' + std::to_string(references[static_cast<Index>(i)]) + '\n';
  for (const auto& [shape, keyword] :
       {std::pair{CellShape::triangle3, "Triangles\n"}, std::pair{CellShape::tetrahedron4, "Tetrahedra\n"}})
    text += keyword + std::to_string(counts[shape]) + '\n' + rows[shape];
  return text + "End\n";
}

/// Medit as binary data. Positions of sections have 4 bytes, from version 3 on 8; integers have 8 bytes in version 4,
/// real numbers 4 in version 1.
inline std::string medit_binary(const FileMesh& m, int version, bool swap) {
  std::map<Index, int> references;
  std::string text = i32(1, swap) + i32(version, swap);
  const auto position = [&](std::size_t at) {
    const auto byte = static_cast<Index>(at);
    return version < 3 ? i32(byte, swap) : i64(byte, swap);
  };
  const auto integer = [&](Index n) { return version < 4 ? i32(n, swap) : i64(n, swap); };
  const auto add = [&](int code, const std::string& data) {
    const std::size_t next = text.size() + 4 + position(0).size() + data.size();
    text += i32(code, swap) + position(next) + data;
  };
  add(3, i32(3, swap));
  std::map<CellShape, std::string> rows;
  std::map<CellShape, Index> counts;
  for (const FileCell& c : m.cells) {
    if (c.shape == CellShape::point) references[node_of(m, c, 0)] = tag_of(m, c);
    for (int a = 0; a < facts(c.shape).nodes; ++a) rows[c.shape] += integer(node_of(m, c, a) + 1);
    rows[c.shape] += integer(tag_of(m, c));
    ++counts[c.shape];
  }
  std::string vertices = integer(static_cast<Index>(m.positions.size()));
  for (std::size_t i = 0; i < m.positions.size(); ++i) {
    for (int k = 0; k < 3; ++k)
      vertices += version == 1 ? bytes(static_cast<float>(m.positions[i][k]), swap) : f64(m.positions[i][k], swap);
    vertices += integer(references[static_cast<Index>(i)]);
  }
  add(4, vertices);
  add(15, integer(1) + integer(2));  // RequiredVertices
  add(6, integer(counts[CellShape::triangle3]) + rows[CellShape::triangle3]);
  add(8, integer(counts[CellShape::tetrahedron4]) + rows[CellShape::tetrahedron4]);
  return text + i32(54, swap) + position(0);
}

}  // namespace test
