// A Gmsh file as a whole: which format it is and which sections it holds.
#pragma once

#include <palpate/io/gmsh_msh2.hpp>
#include <palpate/io/gmsh_msh4.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

/// The command that turns any mesh Gmsh can open into one that is read here.
inline std::string convert_command(const std::string& name) {
  return "Convert it: gmsh " + name + " -save -format msh41 -o converted.msh";
}

/// Reads what follows the version of a binary file: the integer 1, which tells the byte order.
inline void read_byte_order(TextReader& in, Format& format) {
  const std::string_view raw = in.take(4, "the integer 1");
  format.swap = from_bytes<std::int32_t>(raw, false) != 1;
  if (from_bytes<std::int32_t>(raw, format.swap) != 1)
    in.refuse(SetupErrorKind::bad_file, "the integer 1", TextReader::quoted(raw));
}

/// Reads $MeshFormat; MSH 1 has none and its $NOD stays the current line. Refuses MSH 3 and 4.0 as unsupported, with
/// the command that converts them.
inline Format read_format(TextReader& in) {
  in.need_line("$MeshFormat or $NOD");
  if (in.line() == "$NOD") return {1, false, false};
  if (in.line() != "$MeshFormat")
    in.refuse(SetupErrorKind::bad_file, "$MeshFormat or $NOD", TextReader::quoted(in.line()));
  in.need_line("a version number");
  const double version = in.real("a version number");
  const bool is2 = version >= 2.0 && version <= 2.2;
  if (!is2 && version != 4.1)
    in.refuse(SetupErrorKind::unsupported, "MSH 1, 2.2 or 4.1", "MSH " + number(version), convert_command(in.name()));
  Format format{is2 ? 2 : 4, in.integer("0 for ASCII or 1 for binary", 0, 1) == 1, false};
  const Index size = in.integer("a data size", 1, 16);
  in.end_line("the data size");
  if (format.is_binary) {
    if (size != 8)
      in.refuse(SetupErrorKind::unsupported, "binary numbers of 8 bytes", std::to_string(size),
                convert_command(in.name()));
    read_byte_order(in, format);
  }
  need_mark(in, "$EndMeshFormat");
  return format;
}

/// $PhysicalNames: `count`, then `dimension tag "name"` per line; text in binary files too.
inline void read_physical_names(TextReader& in, State& state) {
  const Index count = read_count(in, "a number of physical names", 6);
  for (Index i = 0; i < count; ++i) {
    in.need_line("a physical name");
    const auto dimension = static_cast<int>(in.integer("a dimension", 0, 3));
    const auto tag = static_cast<int>(in.integer("a physical tag", 1, max_int));
    const std::string_view name = in.rest();
    if (name.size() < 3 || name.front() != '"' || name.back() != '"')
      in.refuse(SetupErrorKind::bad_file, "a name in double quotes", TextReader::quoted(name));
    state.mesh.names.push_back({dimension, tag, std::string(name.substr(1, name.size() - 2))});
  }
}

/// Refuses a section that came before, or that comes at the wrong place; else notes that it is there.
inline void check_order(const TextReader& in, bool& seen, bool in_place, std::string_view order) {
  if (seen) in.refuse(SetupErrorKind::bad_file, "every section once", TextReader::quoted(in.line()) + " again");
  if (!in_place) in.refuse(SetupErrorKind::bad_file, order, TextReader::quoted(in.line()));
  seen = true;
}

/// Reads a section of MSH 4 as text or as binary data.
inline void read_section4(TextReader& in, State& state, void (*text)(TextNumbers, State&),
                          void (*binary)(BinaryNumbers, State&)) {
  state.format.is_binary ? binary({in, state.format.swap}, state) : text({in}, state);
}

/// Moves to the last line of a section that nobody needs.
inline void skip_section(TextReader& in, const State& state, const std::string& end) {
  if (state.format.is_binary) in.skip_to(end);
  while (in.line() != end) in.need_line(end);
}

/// Reads the nodes or elements, in the layout of the format.
inline void read_nodes(TextReader& in, State& state) {
  if (state.format.major == 4)
    read_section4(in, state, msh4::read_nodes<TextNumbers>, msh4::read_nodes<BinaryNumbers>);
  else
    msh2::read_nodes(in, state);
}
inline void read_elements(TextReader& in, State& state) {
  if (state.format.major == 4)
    read_section4(in, state, msh4::read_elements<TextNumbers>, msh4::read_elements<BinaryNumbers>);
  else
    msh2::read_elements(in, state);
}

/// Reads the section whose first line is the current one; skips those nobody needs.
inline void read_section(TextReader& in, State& state) {
  const std::string section(in.line());
  const bool is1 = state.format.major == 1;
  if (section.size() < 2 || section.front() != '$' || section.starts_with("$End") || section.starts_with("$END"))
    in.refuse(SetupErrorKind::bad_file, "the start of a section such as $Nodes", TextReader::quoted(in.line()));
  const std::string end = (is1 ? "$END" : "$End") + section.substr(1);
  if (section == "$PhysicalNames") {
    check_order(in, state.has_names, true, {});
    read_physical_names(in, state);
  } else if (section == "$Entities" && state.format.major == 4) {
    check_order(in, state.has_entities, !state.has_elements, "$Entities before $Elements");
    read_section4(in, state, msh4::read_entities<TextNumbers>, msh4::read_entities<BinaryNumbers>);
  } else if (section == (is1 ? "$NOD" : "$Nodes")) {
    check_order(in, state.has_nodes, true, {});
    read_nodes(in, state);
  } else if (section == (is1 ? "$ELM" : "$Elements")) {
    check_order(in, state.has_elements, state.has_nodes, "the nodes before the elements");
    read_elements(in, state);
  } else if (section == "$PartitionedEntities") {
    in.refuse(SetupErrorKind::unsupported, "a mesh in one part", "a partitioned mesh", "Save it without partitions");
  } else {
    return skip_section(in, state, end);
  }
  need_mark(in, end);
}

/// Reads a whole file. Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, each with file
/// and line (in binary data: byte). Linear in the size of the text, n log n when node ids are not 1 ... n; counts are
/// compared with the size of the text before anything is allocated.
inline FileMesh parse(std::string_view text, const std::string& name) {
  TextReader in(text, name);
  State state(name);
  state.format = read_format(in);
  for (bool more = state.format.major == 1 || in.next_line(); more; more = in.next_line()) read_section(in, state);
  if (!state.has_elements)
    in.refuse(SetupErrorKind::bad_file, state.has_nodes ? "a section of elements" : "a section of nodes",
              "the end of the file");
  return std::move(state.mesh);
}

}}}  // namespace palpate::io::gmsh
