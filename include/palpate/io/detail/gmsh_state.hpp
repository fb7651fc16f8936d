// State while a Gmsh file is read, and small functions that all Gmsh formats share.
#pragma once

#include <palpate/io/detail/gmsh_types.hpp>
#include <palpate/io/detail/id_table.hpp>
#include <palpate/io/detail/labels.hpp>
#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/detail/tag_sets.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

/// The version of the format, and how numbers are written.
struct Format {
  int major = 4;
  bool is_binary = false;
  bool swap = false;  ///< binary numbers have the opposite byte order
};

/// State while a file is read.
struct State {
  explicit State(const std::string& name) : mesh(name) {}
  Format format;
  FileMesh mesh;
  bool has_names = false, has_entities = false, has_nodes = false, has_elements = false;
  TagSets sets;
  PairMap entities;       ///< MSH 4: (dimension, entity tag) -> set of physical tags
  Index memberships = 0;  ///< MSH 4: pairs of an element and a group

  bool by_elementary = false;  ///< elementary tags replace the physical ones
  bool has_physical = false;   ///< a solid has a physical tag
  LabelCount elementary;       ///< elementary tags of the solids
};

/// Reads an element type number; refuses one that is not in `types`.
const Type& read_type(const Numbers& in);

/// The tag of an element of that shape that is used, and counts both.
int used_tag(State& state, CellShape shape, int physical, int elementary);

/// Reads a physical tag. A minus sign only marks reversed orientation and is dropped.
int read_physical(const Numbers& in);

/// Requires the line `mark`.
void need_mark(TextReader& in, std::string_view mark);

/// Reads a line that contains only a count.
Index read_count(TextReader& in, std::string_view what, Index bytes_each);

inline const Type& read_type(const Numbers& in) {
  const Index wanted = in.integer("an element type", 1, max_int);
  const Type* type = find_type(wanted);
  if (type == nullptr)
    in.in.refuse(SetupErrorKind::unsupported, "a known Gmsh element type", {"'", wanted, "'"},
                 "Mesh again with elements of first or second order");
  return *type;
}

inline int used_tag(State& state, CellShape shape, int physical, int elementary) {
  if (facts(shape).dimension == 3) {
    state.has_physical = state.has_physical || physical != 0;
    state.elementary.add(elementary);
  }
  return state.by_elementary ? elementary : physical;
}

inline int read_physical(const Numbers& in) {
  const auto tag = static_cast<int>(in.integer("a physical tag", -max_int, max_int));
  return tag < 0 ? -tag : tag;
}

PALPATE_COLD inline void need_mark(TextReader& in, std::string_view mark) {
  in.need_line(mark);
  if (in.line() != mark) in.refuse(SetupErrorKind::bad_file, mark, in_quotes(in.line()));
}

PALPATE_COLD inline Index read_count(TextReader& in, std::string_view what, Index bytes_each) {
  in.need_line(what);
  const Index count = in.count(what, bytes_each);
  in.end_line(what);
  return count;
}

}}}  // namespace palpate::PALPATE_ABI::io::gmsh
