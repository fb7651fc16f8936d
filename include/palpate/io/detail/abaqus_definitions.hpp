// Reads the sets, surfaces and sections of an Abaqus file.
#pragma once

#include <palpate/io/detail/abaqus_groups.hpp>
#include <palpate/io/detail/abaqus_lines.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// Reads the lines that define groups; the current line is the keyword.
class Definitions {
 public:
  explicit Definitions(Lines& lines) : lines_(lines) {}

  void read_node_set() { read_set(groups.nodes, "NSET"); }
  void read_element_set() { read_set(groups.elements, "ELSET"); }

  /// Surfaces of other types than ELEMENT and NODE have no faces of elements and are skipped.
  void read_surface();

  /// Shells and beams have other keywords.
  void read_solid_section();

  Groups groups;
  bool in_assembly =
      false;             ///< ids without an instance are those of reference points of the assembly: they are skipped
  std::string instance;  ///< its name, in upper case

 private:
  void read_set(Sets& sets, std::string_view name_parameter);
  void read_set_line(Sets& sets, bool ids_are_foreign);
  void read_range(Sets& sets);
  void read_surface_line(Surface& surface, bool is_of_nodes);
  Index find_set(const Sets& sets, std::string_view name) const;

  /// "Part-1-1.Set-1" is Set-1 of the instance.
  std::string_view without_instance(std::string_view name) const;

  Lines& lines_;
};

}}}  // namespace palpate::PALPATE_ABI::io::abaqus

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/abaqus_definitions.ipp>
#endif
