// Two tetrahedra as VTU, in every coding, and as FEBio; and the result of reading a text.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/io/xml/read_mesh.hpp>

#include "catch.hpp"

#include <zlib.h>

#include <bit>
#include <cstring>
#include <map>

namespace xml_test {

using palpate::Index;
using palpate::Mesh;
using palpate::Tet4;

/// `text` with the first `from` replaced; fails the test if there is none.
inline std::string with(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  INFO(from);
  REQUIRE(at != std::string::npos);
  return text.replace(at, from.size(), to);
}

/// How a VTU file is written.
struct Coding {
  enum Place { ascii, inline_base64, appended_base64, appended_raw } place = ascii;
  bool is_compressed = false;
  int header_bits = 32;
  bool is_big_endian = false;
  std::size_t block = 64;  ///< bytes of a compressed block
};

/// Bytes of a number in the byte order of the file.
template <class T>
std::string raw_bytes(T value, const Coding& coding) {
  std::string raw(sizeof(T), '\0');
  std::memcpy(raw.data(), &value, sizeof(T));
  const bool swap = coding.is_big_endian != (std::endian::native == std::endian::big);
  return swap ? std::string(raw.rbegin(), raw.rend()) : raw;
}

inline std::string base64(const std::string& bytes) {
  const std::string digits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8U | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k)
      out += i + k > bytes.size() ? '=' : digits[group >> (18 - 6 * static_cast<unsigned>(k)) & 63U];
  }
  return out;
}

inline std::string header(std::size_t value, const Coding& coding) {
  return coding.header_bits == 32 ? raw_bytes(static_cast<std::uint32_t>(value), coding)
                                  : raw_bytes(static_cast<std::uint64_t>(value), coding);
}

/// The bytes of an array in the file: header and data, or header and compressed blocks.
inline std::string encoded(const std::string& bytes, const Coding& coding) {
  const bool is_base64 = coding.place != Coding::appended_raw;
  const auto text = [&](const std::string& raw) { return is_base64 ? base64(raw) : raw; };
  if (!coding.is_compressed) return text(header(bytes.size(), coding) + bytes);
  std::string blocks, sizes;
  std::size_t count = 0;
  for (std::size_t at = 0; at < bytes.size(); at += coding.block, ++count) {
    const std::string part = bytes.substr(at, coding.block);
    std::string packed(compressBound(static_cast<uLong>(part.size())), '\0');
    uLongf size = static_cast<uLongf>(packed.size());
    compress(reinterpret_cast<Bytef*>(packed.data()), &size, reinterpret_cast<const Bytef*>(part.data()),
             static_cast<uLong>(part.size()));
    blocks += packed.substr(0, size);
    sizes += header(size, coding);
  }
  const std::string head =
      header(count, coding) + header(coding.block, coding) + header(bytes.size() % coding.block, coding) + sizes;
  return text(head) + text(blocks);
}

/// A VTU file under construction.
struct VtuWriter {
  Coding coding;
  std::string appended;

  template <class T>
  std::string array(const std::string& type, const std::string& attributes, const std::vector<T>& numbers) {
    std::string bytes, words;
    for (const T n : numbers) {
      bytes += raw_bytes(n, coding);
      words += palpate::io::to_decimal(static_cast<double>(n)) + ' ';
    }
    const std::string head = "<DataArray type=\"" + type + "\" " + attributes;
    if (coding.place == Coding::ascii) return head + " format=\"ascii\">\n" + words + "\n</DataArray>\n";
    const std::string data = encoded(bytes, coding);
    if (coding.place == Coding::inline_base64) return head + " format=\"binary\">\n" + data + "\n</DataArray>\n";
    appended += data;
    return head + " format=\"appended\" offset=\"" + std::to_string(appended.size() - data.size()) + "\"/>\n";
  }

  std::string file(const std::string& grid) const {
    const std::string order = coding.is_big_endian ? "BigEndian" : "LittleEndian";
    std::string text = "<?xml version=\"1.0\"?>\n<VTKFile type=\"UnstructuredGrid\" version=\"0.1\" byte_order=\"" +
                       order + "\" header_type=\"UInt" + std::to_string(coding.header_bits) + "\"" +
                       (coding.is_compressed ? " compressor=\"vtkZLibDataCompressor\"" : "") +
                       ">\n<UnstructuredGrid>\n" + grid + "</UnstructuredGrid>\n";
    if (!appended.empty())
      text += std::string("<AppendedData encoding=\"") + (coding.place == Coding::appended_raw ? "raw" : "base64") +
              "\">\n_" + appended + "\n</AppendedData>\n";
    return text + "</VTKFile>\n";
  }
};

/// Two tetrahedra and a triangle with the regions 1, 1 and 2.
inline std::string vtu(const Coding& coding) {
  VtuWriter w{coding, {}};
  const std::string regions = w.array<std::int32_t>("Int32", "Name=\"region\"", {1, 1, 2});
  const std::string points =
      w.array<double>("Float64", "NumberOfComponents=\"3\"", {0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 1.5, 1, 1});
  const std::string nodes = w.array<std::int64_t>("Int64", "Name=\"connectivity\"", {0, 1, 2, 3, 1, 2, 3, 4, 0, 2, 1});
  const std::string offsets = w.array<std::int32_t>("Int32", "Name=\"offsets\"", {4, 8, 11});
  const std::string types = w.array<std::uint8_t>("UInt8", "Name=\"types\"", {10, 10, 5});
  return w.file("<Piece NumberOfPoints=\"5\" NumberOfCells=\"3\">\n<CellData>\n" + regions + "</CellData>\n<Points>\n" +
                points + "</Points>\n<Cells>\n" + nodes + offsets + types + "</Cells>\n</Piece>\n");
}

inline const std::string febio4 = R"(<?xml version="1.0" encoding="ISO-8859-1"?>
<febio_spec version="4.0">
	<Material><material id="1" name="soft" type="neo-Hookean"/></Material>
	<Mesh>
		<Nodes name="all">
			<node id="10">0,0,0</node>
			<node id="20">1, 0, 0</node>
			<node id="40">0,1,0</node>
			<node id="30">0,0,1</node>
			<node id="50">1.5,1,1</node>
		</Nodes>
		<Elements type="tet4" name="tissue">
			<elem id="7">10,20,40,30</elem>
			<elem id="9">20,40,30,50</elem>
		</Elements>
		<Surface name="base">
			<tri3 id="1">10,40,20</tri3>
		</Surface>
		<ElementSet name="half">9</ElementSet>
		<NodeSet name="tip">50</NodeSet>
		<NodeSet name="some">20,40,
			30</NodeSet>
	</Mesh>
</febio_spec>
)";

inline const std::string febio2 = R"(<febio_spec version="2.5">
<Geometry>
<Nodes>
<node id="1">0,0,0</node>
<node id="2">1,0,0</node>
<node id="3">0,1,0</node>
<node id="4">0,0,1</node>
<node id="5">1.5,1,1</node>
</Nodes>
<Elements type="tet4" mat="1">
<elem id="1">1,2,3,4</elem>
</Elements>
<Elements type="tet4" mat="2" name="tumour">
<elem id="2">2,3,4,5</elem>
</Elements>
<NodeSet name="tip"><node id="5"/></NodeSet>
<ElementSet name="half"><elem id="2"/></ElementSet>
<Surface name="base"><tri3 id="1">1,3,2</tri3></Surface>
</Geometry>
</febio_spec>
)";

/// All samples by name.
inline const std::map<std::string, std::string>& samples() {
  static const std::map<std::string, std::string> all = [] {
    std::map<std::string, std::string> samples{{"febio 4.0", febio4}, {"febio 2.5", febio2}, {"vtu", vtu({})}};
    const std::vector<std::pair<std::string, Coding::Place>> places{
        {"inline", Coding::inline_base64}, {"base64", Coding::appended_base64}, {"raw", Coding::appended_raw}};
    for (const auto& [name, place] : places)
      for (const bool is_compressed : {false, true})
        for (const int bits : {32, 64})
          for (const bool is_big : {false, true})
            samples["vtu " + name + (is_compressed ? " zlib" : "") + (bits == 64 ? " 64" : "") +
                    (is_big ? " big" : "")] = vtu({place, is_compressed, bits, is_big, 64});
    return samples;
  }();
  return all;
}

/// "accepted", or the message of the refusal. An accepted mesh must be valid.
inline std::string complaint(std::string_view text) {
  Mesh<Tet4> mesh;
  try {
    mesh = palpate::io::xml::parse_mesh<Tet4>(text, "mesh");
  } catch (const palpate::SetupError& error) {
    return error.what();
  }
  const Index n = mesh.node_count();
  bool sound = n > 0 && mesh.element_count() > 0;
  for (const auto& x : mesh.positions) sound = sound && x.allFinite();
  for (const auto& element : mesh.elements)
    for (const palpate::NodeId i : element) sound = sound && i >= 0 && i < n;
  for (const palpate::Group& g : mesh.groups.all())
    for (const palpate::NodeId i : g.nodes) sound = sound && i >= 0 && i < n;
  return sound ? "accepted" : "unsound";
}

}  // namespace xml_test
