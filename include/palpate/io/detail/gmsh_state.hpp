// State while a Gmsh file is read, and small functions that all Gmsh formats share.
#pragma once

#include <palpate/io/detail/gmsh_types.hpp>
#include <palpate/io/detail/labels.hpp>
#include <palpate/io/detail/node_ids.hpp>
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

}}}  // namespace palpate::PALPATE_ABI::io::gmsh

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/gmsh_state.ipp>
#endif
