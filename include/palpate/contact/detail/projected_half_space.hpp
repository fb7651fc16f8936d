// What a mesh makes of the compliance of a half-space, vertex by vertex.
#pragma once

#include <palpate/contact/detail/half_space.hpp>

#include <algorithm>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Why the table below is not, or not completely, right at a vertex.
enum class HalfSpaceMark : std::uint8_t {
  sharp_edge = 1,          ///< on an edge where the surface turns by more than 45 degrees: no half-space
  near_edge = 2,           ///< a neighbour on the surface is beyond such an edge, or constrained
  singular = 4,            ///< the mesh around it gave no solution: the vertex is left as it is
  no_surface = 8,          ///< not on the boundary of the body: left as it is
  several_materials = 16,  ///< less than two elements, or an edge, from another material
  anisotropic = 32,        ///< the material differs from the isotropic one that was taken
  near_support = 64,       ///< constrained, or above constrained nodes less than 1.3 edges of an element away
  thin = 128,              ///< less than 0.7 distances between nodes away, too near for the facets: left as it is
};

/// A set of HalfSpaceMark.
struct HalfSpaceMarks {
  std::uint8_t bits = 0;

  void set(HalfSpaceMark mark) noexcept { bits = static_cast<std::uint8_t>(bits | static_cast<std::uint8_t>(mark)); }
  bool has(HalfSpaceMark mark) const noexcept { return (bits & static_cast<std::uint8_t>(mark)) != 0; }
};

/// The compliance of a half-space as the mesh shows it, G_h: for a force on vertex j the displacement of vertex i of
/// the solution on the mesh that is nearest to that of the half-space, times half_space_support. The compliance between
/// two contact points finer than the facets is then
///   supported_compliance(p, q) + N_p^T (C - G_h) N_q,    for p = q with half_space_self_compliance,
/// with the weights N of the points and the compliance C of the mesh: the singular part of C, which depends on the
/// mesh, is exchanged for that of the half-space. Symmetric. Blocks are stored for pairs within the support, i >= j, by
/// rows.
///
/// A point between vertices is a HalfSpacePoint with the weighted means of root, Poisson ratio and length, and the
/// normal of its facets (SubfacetCompliance::point). Vertices without a solution, and those above a support that is
/// very near, have root 0 and no blocks, so that their points keep the compliance C. So have vertices that are fixed
/// along the normal, which do not keep their neighbours' points from theirs.
class ProjectedHalfSpace {
 public:
  /// Rows of the lower half, the columns of each ascending.
  struct Blocks {
    std::vector<Index> row_start;  ///< rows + 1
    std::vector<int> column;
    std::vector<Matrix3> value;  ///< [m/N]
  };

  ProjectedHalfSpace() = default;
  ProjectedHalfSpace(std::vector<HalfSpacePoint> vertices, std::vector<HalfSpaceMarks> marks, Blocks blocks) noexcept;

  bool empty() const noexcept { return vertices_.empty(); }
  int vertex_count() const noexcept { return static_cast<int>(vertices_.size()); }
  const HalfSpacePoint& vertex(int v) const noexcept { return vertices_[static_cast<std::size_t>(v)]; }
  HalfSpaceMarks marks(int v) const noexcept { return marks_[static_cast<std::size_t>(v)]; }

  /// G_h between two vertices [m/N], zero where none is stored. A binary search in about 30 columns; no allocation.
  Matrix3 operator()(int i, int j) const noexcept;
  /// The stored columns of a row, and their blocks.
  std::span<const int> columns(int row) const noexcept;
  std::span<const Matrix3> blocks(int row) const noexcept;
  std::size_t bytes() const noexcept;

 private:
  std::vector<HalfSpacePoint> vertices_;
  std::vector<HalfSpaceMarks> marks_;
  Blocks blocks_;
};

inline ProjectedHalfSpace::ProjectedHalfSpace(std::vector<HalfSpacePoint> vertices, std::vector<HalfSpaceMarks> marks,
                                              Blocks blocks) noexcept
    : vertices_(std::move(vertices)), marks_(std::move(marks)), blocks_(std::move(blocks)) {}

inline std::span<const int> ProjectedHalfSpace::columns(int row) const noexcept {
  const auto r = static_cast<std::size_t>(row);
  return {blocks_.column.data() + blocks_.row_start[r],
          static_cast<std::size_t>(blocks_.row_start[r + 1] - blocks_.row_start[r])};
}

inline std::span<const Matrix3> ProjectedHalfSpace::blocks(int row) const noexcept {
  return {blocks_.value.data() + blocks_.row_start[static_cast<std::size_t>(row)], columns(row).size()};
}

inline Matrix3 ProjectedHalfSpace::operator()(int i, int j) const noexcept {
  const std::span<const int> row = columns(std::max(i, j));
  const auto at = std::ranges::lower_bound(row, std::min(i, j));
  if (at == row.end() || *at != std::min(i, j)) return Matrix3::Zero();
  const Matrix3& block = blocks(std::max(i, j))[static_cast<std::size_t>(at - row.begin())];
  return i >= j ? block : Matrix3(block.transpose());
}

inline std::size_t ProjectedHalfSpace::bytes() const noexcept {
  return vertices_.size() * (sizeof(HalfSpacePoint) + sizeof(HalfSpaceMarks)) +
         blocks_.row_start.size() * sizeof(Index) + blocks_.column.size() * (sizeof(int) + sizeof(Matrix3));
}

}}}  // namespace palpate::detail
