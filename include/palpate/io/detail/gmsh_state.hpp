// A Gmsh file under way, and small parts that all formats of Gmsh share.
#pragma once

#include <palpate/io/detail/gmsh_types.hpp>
#include <palpate/io/detail/node_ids.hpp>
#include <palpate/io/detail/numbers.hpp>
#include <palpate/io/detail/tag_sets.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace io::gmsh {

/// The version of the format, and how numbers are written.
struct Format {
  int major = 4;
  bool is_binary = false;
  bool swap = false;  ///< binary numbers of the other byte order
};

/// A file under way.
struct State {
  explicit State(const std::string& name) : mesh(name) {}
  Format format;
  FileMesh mesh;
  bool has_names = false, has_entities = false, has_nodes = false, has_elements = false;
  TagSets sets;
  PairMap entities;       ///< MSH 4: (dimension, entity tag) -> set of physical tags
  Index memberships = 0;  ///< MSH 4: of elements in groups
};

/// Reads an element type number; refuses one that is not in `types`.
const Type& read_type(const Numbers& in);

/// Reads a physical tag. A minus sign only says that Gmsh turned the orientation round.
int read_physical(const Numbers& in);

/// Requires the line `mark`.
void need_mark(TextReader& in, std::string_view mark);

/// Reads a line that holds a count and nothing else.
Index read_count(TextReader& in, std::string_view what, Index bytes_each);

}}}  // namespace palpate::PALPATE_ABI::io::gmsh

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/gmsh_state.ipp>
#endif
