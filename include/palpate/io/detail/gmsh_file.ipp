// Definitions of read_msh.hpp: reads whole Gmsh files, their format and sections.
#pragma once

#include <palpate/io/detail/gmsh_msh2.hpp>
#include <palpate/io/detail/gmsh_msh4.hpp>
#include <palpate/io/read_msh.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

namespace detail {

/// The command that converts any mesh Gmsh can open to a format that is read here.
PALPATE_COLD inline std::string convert_command(const std::string& name) {
  return joined({"Convert it: gmsh ", name, " -save -format msh41 -o converted.msh"});
}

/// Reads what follows the version of a binary file: the integer 1, which shows the byte order.
PALPATE_COLD inline void read_byte_order(TextReader& in, Format& format) {
  const std::string_view raw = in.read_bytes(4, "the integer 1");
  format.swap = from_bytes<std::int32_t>(raw, false) != 1;
  if (from_bytes<std::int32_t>(raw, format.swap) != 1)
    in.refuse(SetupErrorKind::bad_file, "the integer 1", in_quotes(raw));
}

/// Reads $MeshFormat, and $Comments before it; MSH 1 has none, and its $NOD remains the current line. Refuses MSH 3
/// and 4.0 as unsupported, with the command that converts them.
PALPATE_COLD inline Format read_format(TextReader& in) {
  in.need_line("$MeshFormat or $NOD");
  for (; in.line() == "$Comments"; in.need_line("$MeshFormat or $NOD"))
    while (in.line() != "$EndComments") in.need_line("$EndComments");
  if (in.line() == "$NOD") return {1, false, false};
  if (in.line() != "$MeshFormat") {
    const bool called_msh = in.name().ends_with(".msh") || in.name().ends_with(".MSH");
    in.refuse(SetupErrorKind::bad_file, "$MeshFormat or $NOD", in_quotes(in.line()),
              {called_msh ? "Other programs call their files .msh too. Convert it: "
                          : "Other formats are read by io::read_mesh (palpate/io.hpp), or converted: ",
               meshio_command(in.name())});
  }
  in.need_line("a version number");
  const double version = in.real("a version number");
  const bool is2 = version >= 2.0 && version <= 2.2;
  if (!is2 && version != 4.1)
    in.refuse(SetupErrorKind::unsupported, "MSH 1, 2.2 or 4.1", {"MSH ", version}, convert_command(in.name()));
  Format format{is2 ? 2 : 4, in.integer("0 for ASCII or 1 for binary", 0, 1) == 1, false};
  const Index size = in.integer("a data size", 1, 16);
  in.end_line("the data size");
  if (format.is_binary) {
    if (size != 8)
      in.refuse(SetupErrorKind::unsupported, "binary numbers of 8 bytes", {size}, convert_command(in.name()));
    read_byte_order(in, format);
  }
  need_mark(in, "$EndMeshFormat");
  return format;
}

/// $PhysicalNames: `count`, then `dimension tag "name"` per line; text in binary files too.
PALPATE_COLD inline void read_physical_names(TextReader& in, State& state) {
  const Index count = read_count(in, "a number of physical names", 6);
  for (Index i = 0; i < count; ++i) {
    in.need_line("a physical name");
    const auto dimension = static_cast<int>(in.integer("a dimension", 0, 3));
    const auto tag = static_cast<int>(in.integer("a physical tag", 1, max_int));
    const std::string_view name = in.rest();
    if (name.size() < 3 || name.front() != '"' || name.back() != '"')
      in.refuse(SetupErrorKind::bad_file, "a name in double quotes", in_quotes(name));
    state.mesh.names.push_back({dimension, tag, std::string(name.substr(1, name.size() - 2))});
  }
}

/// Refuses a section that is repeated or at the wrong place; otherwise sets `seen`.
PALPATE_COLD inline void check_order(const TextReader& in, bool& seen, bool in_place, std::string_view order) {
  if (seen) in.refuse(SetupErrorKind::bad_file, "every section once", {in_quotes(in.line()), " again"});
  if (!in_place) in.refuse(SetupErrorKind::bad_file, order, in_quotes(in.line()));
  seen = true;
}

/// Moves to the last line of a section that is not used. In binary files some programs write it without a line end
/// before it.
inline void skip_section(TextReader& in, const State& state, const std::string& end) {
  if (state.format.is_binary) in.skip_to(end);
  while (in.line() != end) in.need_line(end);
}

/// Reads the section whose first line is the current one; skips sections that are not used.
inline void read_section(TextReader& in, State& state) {
  const std::string_view section = in.line();
  const bool is1 = state.format.major == 1;
  if (section.size() < 2 || section.front() != '$' || section.starts_with("$End") || section.starts_with("$END"))
    in.refuse(SetupErrorKind::bad_file, "the start of a section such as $Nodes", in_quotes(in.line()));
  const std::string end = joined({is1 ? "$END" : "$End", section.substr(1)});
  if (section == "$PhysicalNames") {
    check_order(in, state.has_names, true, {});
    read_physical_names(in, state);
  } else if (section == "$Entities" && state.format.major == 4) {
    check_order(in, state.has_entities, !state.has_elements, "$Entities before $Elements");
    msh4::read_entities(in, state);
  } else if (section == (is1 ? "$NOD" : "$Nodes")) {
    check_order(in, state.has_nodes, true, {});
    state.format.major == 4 ? msh4::read_nodes(in, state) : msh2::read_nodes(in, state, false);
  } else if (section == "$ParametricNodes" && state.format.major == 2) {
    check_order(in, state.has_nodes, true, {});
    msh2::read_nodes(in, state, true);
  } else if (section == (is1 ? "$ELM" : "$Elements")) {
    check_order(in, state.has_elements, state.has_nodes, "the nodes before the elements");
    state.format.major == 4 ? msh4::read_elements(in, state) : msh2::read_elements(in, state);
  } else if (section == "$PartitionedEntities") {
    in.refuse(SetupErrorKind::unsupported, "a mesh in one part", "a partitioned mesh", "Save it without partitions");
  } else {
    return skip_section(in, state, end);
  }
  need_mark(in, end);
}

/// A note if the elementary tags are lost and may be labels; no names if they are used.
PALPATE_COLD inline void finish_labels(State& state) {
  if (state.by_elementary) state.mesh.names.clear();
  if (!state.by_elementary && !state.has_physical && state.elementary.looks_like_labels())
    state.mesh.notes.push_back(joined({"no solid has a physical tag, but the ", state.elementary.different(),
                                       " elementary tags may be labels of tissues: {.labels = \"elementary\"} in "
                                       "ReadOptions makes them the regions"}));
}

}  // namespace detail

PALPATE_INLINE FileMesh parse(std::string_view text, const std::string& name, std::string_view labels) {
  TextReader in(text, name);
  State state(name);
  state.by_elementary = labels == "elementary";
  if (!state.by_elementary && !labels.empty())
    refuse(SetupErrorKind::bad_argument, {name, ": labels ", in_quotes(labels), " in a Gmsh file"},
           "Its labels are the physical tags; {.labels = \"elementary\"} takes the elementary ones");
  state.format = detail::read_format(in);
  for (bool more = state.format.major == 1 || in.next_line(); more; more = in.next_line())
    detail::read_section(in, state);
  if (!state.has_elements)
    in.refuse(SetupErrorKind::bad_file, state.has_nodes ? "a section of elements" : "a section of nodes",
              "the end of the file");
  detail::finish_labels(state);
  return std::move(state.mesh);
}

}}}  // namespace palpate::PALPATE_ABI::io::gmsh
