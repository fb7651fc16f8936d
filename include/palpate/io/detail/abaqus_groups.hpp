// The sets, sections and surfaces of an Abaqus file as groups and regions.
#pragma once

#include <palpate/io/detail/id_table.hpp>
#include <palpate/io/file_mesh.hpp>

#include <functional>
#include <map>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io::abaqus {

/// Sets are read in any order with nodes and elements, and resolved at the end. Definitions of the same name add to one
/// set. Names do not depend on the case. Sets of the assembly are apart from those of the part.
class Sets {
 public:
  struct Set {
    std::string name;
    bool of_assembly, is_internal;
    std::vector<int> members;  ///< positions, ascending; empty before resolve()
  };

  /// What the following calls add to: the set of that name.
  void open(const std::string& name, bool of_assembly, bool is_internal = false);

  /// An id, or ids from `first` to `last` in steps.
  void add_ids(Index first, Index last, Index step, Index line);

  /// All nodes or elements at positions from `first` to before `last`.
  void add_positions(std::size_t first, std::size_t last);

  /// All members that the set at this position has so far.
  void add_set(Index set);

  /// In a set of nodes: all nodes of the elements in the set of elements at this position.
  void add_nodes_of(Index element_set);

  /// The position of a set, -1 if there is none; in the assembly its own sets come first.
  Index find(std::string_view name, bool of_assembly) const;

  /// Adds the nodes of the elements in a set to `nodes`.
  using NodesOf = std::function<void(Index element_set, std::vector<int>& nodes)>;

  /// Finds the members of all sets; `nodes_of` is needed for sets of nodes only. `memberships` counts them, with
  /// repetitions, in all sets of the file: a few bytes can put every element into a set, and memory must stay
  /// proportional to the size of the file.
  void resolve(const IdTable& ids, const TextReader& in, Index& memberships, const NodesOf& nodes_of = {});

  const std::vector<Set>& all() const noexcept { return sets_; }

 private:
  /// 16 bytes, because an id in a set may be two bytes of the file. `step` is 0 for positions, -1 for a set, -2 for a
  /// set of elements.
  struct Item {
    int first, last, step, line;
  };
  struct Definition {
    std::size_t set, first_item;
  };

  void add(std::vector<int>& members, const Item& item, const IdTable& ids, const TextReader& in, Index& memberships,
           const NodesOf& nodes_of);

  std::vector<Set> sets_;
  std::map<std::pair<bool, std::string>, Index> by_name_;
  std::vector<Definition> definitions_;
  std::vector<Item> items_;
};

/// Refuses more memberships in groups than bytes in the file.
void check_memberships(const TextReader& in, Index memberships);

/// A line of a *SURFACE: a face of an element or of all elements of a set, or a node or a set of nodes.
struct SurfacePart {
  Index id, set;  ///< id of an element or a node, or -1 and the set
  int face;       ///< 0 for S1; shell for the element itself; of_nodes for nodes
  Index line;

  static constexpr int shell = -1, of_nodes = -2;
};

struct Surface {
  std::string name;
  std::vector<SurfacePart> parts;
};

/// All that defines groups.
struct Groups {
  Sets nodes, elements;
  std::vector<Index> sections;  ///< sets of elements
  std::vector<Surface> surfaces;

  std::vector<Index> element_blocks;  ///< the sets of *ELEMENT lines: the regions if there are no sections
};

/// Adds tags, names and the cells of faces and nodes to a mesh with all its nodes and elements. `cells` has the cell of
/// every element, -1 for one without a shape. Section r is region r with the tag r + 1; an element of two sections
/// belongs to the first.
void add_groups(Groups& groups, const IdTable& nodes, const IdTable& elements, std::span<const Index> cells,
                const TextReader& in, FileMesh& mesh);

}}}  // namespace palpate::PALPATE_ABI::io::abaqus

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/abaqus_groups.ipp>
#endif
