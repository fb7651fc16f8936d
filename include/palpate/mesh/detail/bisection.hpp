// Bisection of the longest edges of tetrahedra.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

#include <array>
#include <compare>
#include <cstdint>
#include <functional>
#include <queue>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Two nodes, the smaller id first.
using NodePair = std::pair<NodeId, NodeId>;
inline NodePair node_pair(NodeId a, NodeId b) noexcept {
  return a < b ? NodePair{a, b} : NodePair{b, a};
}

/// Mean ratio of a tetrahedron, the quality of element_shape; 0 if it is inverted.
double mean_ratio(const Vector3& a, const Vector3& b, const Vector3& c, const Vector3& d) noexcept;

/// A mesh of tetrahedra in which edges are divided, together with all elements around them, so that it stays
/// conforming. Edges have a total order: by length, which counts as equal if only rounding differs, then by the
/// position of the middle, then by node ids. Only the last one depends on the numbering.
class Bisection {
 public:
  /// Least quality of the elements that an edge would be divided into, by the position of the new node.
  using QualityAt = std::function<double(const Vector3&)>;
  /// Position of the new node of an edge on the boundary, whose middle and length are given.
  using Place = std::function<Vector3(NodeId node, const Vector3& middle, double length, const QualityAt& quality_at)>;

  /// Wanted length of an edge, by its middle and its length [m]; infinity is as good as any length that is not shorter
  /// than that of the edge.
  using Wanted = std::function<double(const Vector3& middle, double length)>;

  struct Limits {
    Index most_nodes = 0;        ///< and 2^31 elements
    double least_quality = 0.0;  ///< an edge is not divided if an element would get less
    Place place_on_boundary{};   ///< empty: the middle
  };

  /// Elements must have positive volume. O(elements), allocates.
  Bisection(const Mesh<Tet4>& mesh, Limits limits);

  struct TooLong {
    Index count = 0;
    double worst = 0.0;  ///< ratio of length and wanted length
  };
  /// Divides edges longer than wanted, the worst ratio first, after all longer edges of the elements around
  /// them (Rivara 1984). Every edge that is divided is longer than the least wanted length, and the volume of an
  /// element has a lower bound by its quality and longest edge, so that it ends. `wanted` must be positive. Returns the
  /// edges that are still too long.
  TooLong refine(const Wanted& wanted);

  /// Whether a limit of the size is reached.
  bool is_full() const noexcept;

  /// Moves a node if no element around it gets a quality below the limit.
  bool move(NodeId node, const Vector3& to);

  const std::vector<Vector3>& positions() const noexcept { return positions_; }
  std::vector<Vector3>& positions() noexcept { return positions_; }
  /// The edges that were divided, in the order of their new nodes, the first of which has the id `first_new_node()`.
  const std::vector<NodePair>& divided() const noexcept { return divided_; }
  NodeId first_new_node() const noexcept { return first_new_; }
  /// The elements in the order of those they replace; `first[e]` ... `first[e + 1]` replace element e.
  struct Elements {
    std::vector<Mesh<Tet4>::Connectivity> elements;
    std::vector<Index> first;
  };
  Elements sorted_elements() const;

 private:
  using Element = std::int32_t;

  /// Order of an edge.
  struct Rank {
    std::uint64_t length = 0;  ///< of the square, rounded
    Vector3 middle = Vector3::Zero();
    NodePair edge;

    bool operator<(const Rank& other) const noexcept;
  };
  struct Wish {
    double ratio;
    Rank rank;

    bool operator<(const Wish& other) const noexcept {
      return ratio != other.ratio ? ratio < other.ratio : rank < other.rank;
    }
  };

  const Vector3& at(NodeId i) const noexcept { return positions_[static_cast<std::size_t>(i)]; }
  std::vector<Element>& star(NodeId i) noexcept { return star_[static_cast<std::size_t>(i)]; }
  const std::vector<Element>& star(NodeId i) const noexcept { return star_[static_cast<std::size_t>(i)]; }
  Vector3 middle_of(const NodePair& e) const noexcept { return 0.5 * (at(e.first) + at(e.second)); }
  Rank rank(const NodePair& edge) const noexcept;
  void find_longest(Element e) noexcept;
  NodePair longest_of(Element e) const noexcept;
  template <class Visit>
  void each_edge(Visit visit) const;

  /// Writes the elements around an edge to `around_`.
  void find_around(const NodePair& edge);
  NodePair longest_around(const NodePair& edge) const noexcept;
  bool is_on_boundary(const NodePair& edge);
  double quality_at(const NodePair& edge, const Vector3& middle) const noexcept;
  bool divide(const NodePair& edge);
  void wish(const NodePair& edge, const Wanted& wanted);
  bool fulfil(const NodePair& edge, const Wanted& wanted);

  Limits limits_;
  std::vector<Vector3> positions_;
  std::vector<Mesh<Tet4>::Connectivity> elements_;
  std::vector<Element> parent_;
  std::vector<std::uint8_t> longest_;       ///< of every element: its place in `pairs`
  std::vector<std::vector<Element>> star_;  ///< elements at every node
  std::vector<NodePair> divided_;
  NodeId first_new_ = 0;
  std::priority_queue<Wish> wishes_;
  std::vector<Element> around_;
  std::vector<NodeId> others_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/bisection.ipp>
#endif
