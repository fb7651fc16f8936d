// What a Gmsh file says, before anybody asks which element type is wanted.
#pragma once

#include <palpate/io/text_reader.hpp>

#include <algorithm>
#include <array>
#include <cstdlib>
#include <limits>
#include <utility>
#include <vector>

namespace palpate::inline PALPATE_ABI::io::gmsh {

/// An element type of Gmsh: its number in the file, dimension, number of nodes and name.
struct Type {
  int number;
  int dimension;
  int nodes;
  std::string_view name;
};

/// Every type a file may hold. What becomes of them is decided by GmshElement<E> in io/gmsh_elements.hpp.
inline constexpr std::array types{
    Type{15, 0, 1, "point"},
    Type{1, 1, 2, "2-node line"},
    Type{8, 1, 3, "3-node line"},
    Type{26, 1, 4, "4-node line"},
    Type{27, 1, 5, "5-node line"},
    Type{2, 2, 3, "3-node triangle"},
    Type{9, 2, 6, "6-node triangle"},
    Type{21, 2, 10, "10-node triangle"},
    Type{3, 2, 4, "4-node quadrangle"},
    Type{16, 2, 8, "8-node quadrangle"},
    Type{10, 2, 9, "9-node quadrangle"},
    Type{4, 3, 4, "4-node tetrahedron"},
    Type{11, 3, 10, "10-node tetrahedron"},
    Type{29, 3, 20, "20-node tetrahedron"},
    Type{5, 3, 8, "8-node hexahedron"},
    Type{17, 3, 20, "20-node hexahedron"},
    Type{12, 3, 27, "27-node hexahedron"},
    Type{6, 3, 6, "6-node prism"},
    Type{18, 3, 15, "15-node prism"},
    Type{13, 3, 18, "18-node prism"},
    Type{7, 3, 5, "5-node pyramid"},
    Type{19, 3, 13, "13-node pyramid"},
    Type{14, 3, 14, "14-node pyramid"},
};

/// The type of that number, or nullptr.
constexpr const Type* find_type(Index number) noexcept {
  for (const Type& t : types)
    if (t.number == number) return &t;
  return nullptr;
}

/// A physical group as $PhysicalNames declares it.
struct PhysicalName {
  int dimension;
  int tag;
  std::string name;
};

/// One line of $Elements. Its nodes are `type->nodes` entries of Data::row_nodes from `first_node` on.
struct Row {
  Index tag;
  Index line;
  std::size_t first_node;
  const Type* type;
  std::size_t physical_set;  ///< entry of Data::physical_sets
};

/// The formats that are read.
enum class Format { msh2, msh4 };

/// A parsed file. Node ids are already positions in `node_tags`.
struct Data {
  Format format = Format::msh2;
  std::vector<Vector3> positions;
  std::vector<Index> node_tags;
  std::vector<PhysicalName> names;
  std::vector<std::vector<int>> physical_sets{{}};  ///< lists of physical tags, all > 0; entry 0 is "none"
  std::vector<Row> rows;
  std::vector<NodeId> row_nodes;
  bool has_nodes = false, has_elements = false;
};

inline constexpr Index max_tag = std::numeric_limits<Index>::max();
inline constexpr Index max_int = std::numeric_limits<int>::max();

/// Finds nodes by the ids of the file. Free when these are 1 ... n in order, else a binary search.
class NodeLookup {
 public:
  /// Refuses an id that occurs twice. O(n log n) unless the ids are 1 ... n.
  NodeLookup(const std::vector<Index>& tags, const TextReader& in) : count_(static_cast<Index>(tags.size())) {
    for (std::size_t i = 0; i < tags.size() && in_order_; ++i) in_order_ = tags[i] == static_cast<Index>(i) + 1;
    if (count_ > max_int) raise(SetupErrorKind::too_large, in.name() + ": " + std::to_string(count_) + " nodes");
    if (in_order_) return;
    sorted_.reserve(tags.size());
    for (std::size_t i = 0; i < tags.size(); ++i) sorted_.emplace_back(tags[i], static_cast<NodeId>(i));
    std::ranges::sort(sorted_);
    const auto twice = std::ranges::adjacent_find(sorted_, {}, &std::pair<Index, NodeId>::first);
    if (twice != sorted_.end())
      in.refuse(SetupErrorKind::bad_file, "every node id once", "node " + std::to_string(twice->first) + " twice");
  }

  /// Reads a node id of the current line; refuses one that $Nodes does not hold as index_out_of_range.
  NodeId read(TextReader& in) const {
    const Index tag = in.integer("a node id", 1, in_order_ ? count_ : max_tag);
    if (in_order_) return static_cast<NodeId>(tag - 1);
    const auto it = std::ranges::lower_bound(sorted_, tag, {}, &std::pair<Index, NodeId>::first);
    if (it == sorted_.end() || it->first != tag)
      in.refuse(SetupErrorKind::index_out_of_range, "the id of a node of this file", '\'' + std::to_string(tag) + '\'');
    return it->second;
  }

 private:
  Index count_;
  bool in_order_ = true;
  std::vector<std::pair<Index, NodeId>> sorted_;
};

/// Reads three coordinates of the current line.
inline Vector3 read_point(TextReader& in) {
  Vector3 x;
  for (int i = 0; i < 3; ++i) x[i] = in.real("a coordinate");
  return x;
}

/// Reads an element type number; refuses one that is not in `types`.
inline const Type* read_type(TextReader& in) {
  const Index wanted = in.integer("an element type", 1, max_int);
  const Type* type = find_type(wanted);
  if (type == nullptr)
    in.refuse(SetupErrorKind::unsupported, "a known Gmsh element type", '\'' + std::to_string(wanted) + '\'',
              "Mesh again with elements of first or second order");
  return type;
}

/// Reads a physical tag. A minus sign only says that Gmsh turned the orientation round.
inline int read_physical(TextReader& in) {
  return static_cast<int>(std::abs(in.integer("a physical tag", -max_int, max_int)));
}

/// Requires the line $End<section>.
inline void end_section(TextReader& in, std::string_view section) {
  const std::string expected = "$End" + std::string(section);
  in.need_line(expected);
  if (in.line() != expected) in.refuse(SetupErrorKind::bad_file, expected, TextReader::quoted(in.line()));
}

/// Skips a section that nobody needs.
inline void skip_section(TextReader& in, std::string_view section) {
  const std::string end = "$End" + std::string(section);
  do in.need_line(end);
  while (in.line() != end);
}

}  // namespace palpate::inline PALPATE_ABI::io::gmsh
