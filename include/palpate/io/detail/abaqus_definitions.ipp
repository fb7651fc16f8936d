// Definitions of abaqus_definitions.hpp.
#pragma once

#include <palpate/io/detail/abaqus_definitions.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

namespace detail {

inline bool is_number(std::string_view field) {
  return !field.empty() && (field[0] == '-' || field[0] == '+' || (field[0] >= '0' && field[0] <= '9'));
}

}  // namespace detail

PALPATE_COLD PALPATE_INLINE std::string_view Definitions::without_instance(std::string_view name) const {
  const std::size_t dot = name.find('.');
  const bool has_instance = dot < name.size() && !instance.empty() && upper(name.substr(0, dot)) == instance;
  return without_quotes(has_instance ? name.substr(dot + 1) : name);
}

PALPATE_COLD PALPATE_INLINE Index Definitions::find_set(const Sets& sets, std::string_view name) const {
  const Index set = sets.find(name, in_assembly);
  if (set < 0) lines_.in.refuse(SetupErrorKind::bad_file, "a set above in this file", in_quotes(name));
  return set;
}

PALPATE_INLINE void Definitions::read_set(Sets& sets, std::string_view name_parameter) {
  lines_.read_parameters();
  const std::string name = lines_.need_value(name_parameter);
  const bool is_foreign = in_assembly && !lines_.has("INSTANCE");
  sets.open(name, in_assembly, lines_.has("INTERNAL"));
  if (name_parameter == "NSET" && lines_.has("ELSET"))
    sets.add_nodes_of(find_set(groups.elements, without_instance(lines_.need_value("ELSET"))));
  while (lines_.next_data()) {
    if (!lines_.has("GENERATE"))
      read_set_line(sets, is_foreign);
    else if (!is_foreign)
      read_range(sets);
  }
}

PALPATE_INLINE void Definitions::read_set_line(Sets& sets, bool ids_are_foreign) {
  while (!lines_.in.rest().empty()) {
    const std::string_view rest = lines_.in.rest();
    if (!detail::is_number(rest)) {
      const std::string_view whole = lines_.in.token(), name = without_instance(whole);
      if (!detail::is_number(name) || name.size() == whole.size()) {
        sets.add_set(find_set(sets, name));
        continue;
      }
      TextReader digits(name, lines_.in.name());
      digits.next_line();
      const Index id = digits.integer("an id", 1, max_int);
      sets.add_ids(id, id, 1, lines_.in.place());
      continue;
    }
    const Index id = lines_.in.integer("an id", 1, max_int);
    if (!ids_are_foreign) sets.add_ids(id, id, 1, lines_.in.place());
  }
}

PALPATE_INLINE void Definitions::read_range(Sets& sets) {
  const Index first = lines_.in.integer("a first id", 1, max_int),
              last = lines_.in.integer("a last id", first, max_int);
  const Index step = lines_.in.rest().empty() ? 1 : lines_.in.integer("a step of ids", 1, max_int);
  lines_.in.end_line("a range of ids");
  sets.add_ids(first, last, step, lines_.in.place());
}

PALPATE_INLINE void Definitions::read_surface() {
  lines_.read_parameters();
  const std::string type = upper(lines_.value("TYPE"));
  const bool is_of_nodes = type == "NODE";
  if (!is_of_nodes && !type.empty() && type != "ELEMENT") return;
  if (lines_.has("COMBINE")) lines_.refuse_keyword("a surface of faces", "Write the faces of the combined surface");
  Surface surface{lines_.need_value("NAME"), {}};
  while (lines_.next_data()) read_surface_line(surface, is_of_nodes);
  groups.surfaces.push_back(std::move(surface));
}

PALPATE_INLINE void Definitions::read_surface_line(Surface& surface, bool is_of_nodes) {
  const Sets& sets = is_of_nodes ? groups.nodes : groups.elements;
  SurfacePart part{-1, -1, SurfacePart::of_nodes, lines_.in.place()};
  if (detail::is_number(lines_.in.rest())) {
    part.id = lines_.in.integer("an id", 1, max_int);
  } else {
    part.set = find_set(sets, without_instance(lines_.in.token()));
  }
  if (!is_of_nodes) {
    const std::string_view face = lines_.in.token();
    const std::string name = upper(face);
    if (name.size() == 2 && name[0] == 'S' && name[1] >= '1' && name[1] <= '6')
      part.face = name[1] - '1';
    else if (name == "SPOS" || name == "SNEG" || name == "S" || name.empty())
      part.face = SurfacePart::shell;
    else
      lines_.in.refuse(SetupErrorKind::unsupported, "a face S1 to S6, SPOS or SNEG", in_quotes(face));
  }
  surface.parts.push_back(part);
}

PALPATE_COLD PALPATE_INLINE void Definitions::read_solid_section() {
  lines_.read_parameters();
  if (in_assembly || lines_.value("ELSET").empty()) return;
  groups.sections.push_back(find_set(groups.elements, lines_.value("ELSET")));
}

}}}  // namespace palpate::PALPATE_ABI::io::abaqus
