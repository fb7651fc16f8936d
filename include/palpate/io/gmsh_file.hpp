// A Gmsh file as a whole: which format it is and which sections it holds.
#pragma once

#include <palpate/io/gmsh_msh2.hpp>
#include <palpate/io/gmsh_msh4.hpp>

namespace palpate::inline PALPATE_ABI::io::gmsh {

/// The command that turns any mesh Gmsh can open into one that is read here.
inline std::string convert_command(const std::string& name) {
  return "Convert it: gmsh " + name + " -save -format msh41 -setnumber Mesh.Binary 0 -o converted.msh";
}

/// Reads $MeshFormat. Refuses MSH 1, 3, 4.0 and binary files as unsupported, with the command that converts them.
inline Format read_format(TextReader& in) {
  in.need_line("$MeshFormat");
  if (in.line() == "$NOD" || in.line() == "$NOE")
    in.refuse(SetupErrorKind::unsupported, "MSH 2.2 or 4.1", "MSH 1", convert_command(in.name()));
  if (in.line() != "$MeshFormat")
    in.refuse(
        SetupErrorKind::bad_file, "$MeshFormat", TextReader::quoted(in.line()),
        "Only Gmsh files are read; meshio and gmsh convert others: meshio convert " + in.name() + " converted.msh");
  in.need_line("a version number");
  const double version = in.real("a version number");
  const bool is2 = version >= 2.0 && version <= 2.2;
  if (!is2 && version != 4.1)
    in.refuse(SetupErrorKind::unsupported, "MSH 2.2 or 4.1", "MSH " + number(version), convert_command(in.name()));
  if (in.integer("0 for ASCII or 1 for binary", 0, 1) == 1)
    in.refuse(SetupErrorKind::unsupported, "an ASCII file", "a binary one", convert_command(in.name()));
  in.integer("a data size", 1, 16);
  in.end_line("the data size");
  end_section(in, "MeshFormat");
  return is2 ? Format::msh2 : Format::msh4;
}

/// $PhysicalNames: `count`, then `dimension tag "name"` per line.
inline void read_physical_names(TextReader& in, Data& data) {
  in.need_line("the number of physical names");
  const Index count = in.count("a number of physical names", 6);
  in.end_line("the number of physical names");
  for (Index i = 0; i < count; ++i) {
    in.need_line("a physical name");
    const auto dimension = static_cast<int>(in.integer("a dimension", 0, 3));
    const auto tag = static_cast<int>(in.integer("a physical tag", 1, max_int));
    const std::string_view name = in.rest();
    if (name.size() < 3 || name.front() != '"' || name.back() != '"')
      in.refuse(SetupErrorKind::bad_file, "a name in double quotes", TextReader::quoted(name));
    data.names.push_back({dimension, tag, std::string(name.substr(1, name.size() - 2))});
  }
  end_section(in, "PhysicalNames");
}

/// Refuses a section that came before, or that comes at the wrong place.
inline void check_order(const TextReader& in, bool seen, bool in_place, std::string_view order) {
  if (seen) in.refuse(SetupErrorKind::bad_file, "every section once", TextReader::quoted(in.line()) + " again");
  if (!in_place) in.refuse(SetupErrorKind::bad_file, order, TextReader::quoted(in.line()));
}

/// Reads the section whose first line is the current one; skips those nobody needs.
inline void read_section(TextReader& in, Data& data, msh4::Entities& entities) {
  const std::string section(in.line());
  const bool is2 = data.format == Format::msh2;
  if (section.size() < 2 || section.front() != '$' || section.starts_with("$End"))
    in.refuse(SetupErrorKind::bad_file, "the start of a section such as $Nodes", TextReader::quoted(in.line()));
  if (section == "$PhysicalNames") {
    check_order(in, !data.names.empty(), true, {});
    read_physical_names(in, data);
  } else if (section == "$Entities" && !is2) {
    check_order(in, !entities.empty(), !data.has_elements, "$Entities before $Elements");
    msh4::read_entities(in, entities, data);
  } else if (section == "$Nodes") {
    check_order(in, data.has_nodes, true, {});
    data.has_nodes = true;
    is2 ? msh2::read_nodes(in, data) : msh4::read_nodes(in, data);
  } else if (section == "$Elements") {
    check_order(in, data.has_elements, data.has_nodes, "$Nodes before $Elements");
    data.has_elements = true;
    is2 ? msh2::read_elements(in, data) : msh4::read_elements(in, entities, data);
  } else if (section == "$PartitionedEntities") {
    in.refuse(SetupErrorKind::unsupported, "a mesh in one part", "a partitioned mesh", "Save it without partitions");
  } else {
    skip_section(in, section.substr(1));
  }
}

/// Reads a whole file. Errors: bad_file, index_out_of_range, count_too_large, non_finite, unsupported, each with file
/// and line. Linear in the size of the text, n log n when node ids are not 1 ... n; counts are compared with the size
/// of the text before anything is allocated.
inline Data parse(TextReader& in) {
  Data data;
  data.format = read_format(in);
  msh4::Entities entities;
  while (in.next_line()) read_section(in, data, entities);
  if (!data.has_elements)
    in.refuse(SetupErrorKind::bad_file, data.has_nodes ? "$Elements" : "$Nodes", "the end of the file");
  return data;
}

}  // namespace palpate::inline PALPATE_ABI::io::gmsh
