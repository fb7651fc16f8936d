// The compliance of contact points that are closer to each other than the vertices of the mesh.
#pragma once

#include <palpate/contact/detail/projected_half_space.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

struct ContactSample;  // contact_samples.hpp, whose definitions need the class below

}  // namespace detail

/// What has to be added to the compliance of the mesh so that the points of a contact have the dent of an elastic body,
/// not that of the facets (subtraction of the singularity):
///
///     A(x_i, x_j) = N_i^T C N_j + chi G(x_i, x_j) - N_i^T chi G_h N_j
///
/// with the compliance C of the vertices, the weights N of a point, the half-space G, its support chi, and G_h, what
/// mesh and element make of G. C - G_h is smooth: facets interpolate it well. A is symmetric and does not depend on
/// depth, place or history, so that the forces have an energy. G_h is computed at set-up (ProjectedHalfSpace).
/// Immutable afterwards; ticks only read.
class SubfacetCompliance {
 public:
  /// A block chi G_h of two vertices.
  struct Block {
    int vertex;     ///< of the displacement
    Matrix3 shown;  ///< rows displacement, columns force [m/N]
  };

  /// `vertices`: of the contact surface; one with `root` 0 is not known, and points that depend on it have the
  /// compliance of the mesh only. `first`: per vertex j the number of its first block, one past the end last; `blocks`:
  /// displacement of other vertices, and of j itself, per force on j.
  SubfacetCompliance(std::vector<detail::HalfSpacePoint> vertices, std::vector<int> first, std::vector<Block> blocks)
      : vertices_(std::move(vertices)), first_(std::move(first)), blocks_(std::move(blocks)) {
    index_blocks();
  }

  explicit SubfacetCompliance(const detail::ProjectedHalfSpace& table);
  /// A vertex of a surface after cuts.
  struct Copy {
    int origin;       ///< vertex of the surface before; -1: not known
    bool is_changed;  ///< elements around it were removed or parted
  };
  /// The same for the surface of a body that was cut: every vertex has what its origin has. Cuts make a body softer, so
  /// that the compliance of its points remains positive definite. Two copies of a vertex have the same place.
  SubfacetCompliance(const SubfacetCompliance& whole, std::span<const Copy> vertices);

  int vertex_count() const noexcept { return static_cast<int>(vertices_.size()); }
  const detail::HalfSpacePoint& vertex(int v) const noexcept { return vertices_[at(v)]; }
  bool is_known(int v) const noexcept { return vertices_[at(v)].is_known(); }
  bool has_place(int v) const noexcept { return vertices_[at(v)].length > 0.0; }
  std::span<const Block> blocks(int v) const noexcept {
    return {blocks_.data() + first_[at(v)], static_cast<std::size_t>(first_[at(v) + 1] - first_[at(v)])};
  }
  /// Their vertices alone, for searches that need few of the matrices.
  std::span<const int> vertices_of_blocks(int v) const noexcept {
    return {block_vertex_.data() + first_[at(v)], static_cast<std::size_t>(first_[at(v) + 1] - first_[at(v)])};
  }
  std::size_t bytes() const noexcept {
    return vertices_.size() * sizeof(detail::HalfSpacePoint) + first_.size() * sizeof(int) +
           blocks_.size() * (sizeof(Block) + sizeof(int));
  }

  /// A point of the surface with this normal; not known unless all of its vertices are known or fixed. Beside fixed
  /// vertices it has the half-space of the others: they do not affect a dent that is small for the facet. Within
  /// the last quarter of the facet the half-space gets stiffer, and between fixed vertices there is none.
  detail::HalfSpacePoint point(const detail::ContactSample& sample, const Vector3& normal) const noexcept;
  /// Whether `point` is known.
  bool knows(const detail::ContactSample& sample) const noexcept;
  /// chi G of two different points; zero where one is not known [m/N].
  static Matrix3 half_space(const detail::HalfSpacePoint& p, const detail::HalfSpacePoint& q) noexcept;
  /// Whether different vertices may be at the same place.
  bool has_copies() const noexcept { return has_copies_; }
  /// N_p^T chi G_h N_q [m/N]. Searches the blocks of up to three vertices.
  Matrix3 shown(const detail::ContactSample& p, const detail::ContactSample& q) const noexcept;

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  /// Sorts the blocks of every vertex by the number of the other vertex, for `find`, and fills `block_vertex_`.
  void index_blocks();
  /// The block for the displacement of vertex i per force on vertex j; null where none is stored. A binary search.
  const Block* find(int i, int j) const noexcept;

  std::vector<detail::HalfSpacePoint> vertices_;
  std::vector<int> first_;
  std::vector<Block> blocks_;
  std::vector<int> block_vertex_;  // of each block, without the matrices
  bool has_copies_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/subfacet_compliance.ipp>
#endif
