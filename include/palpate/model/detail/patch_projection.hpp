// Solves for what one patch of a mesh makes of the field of a half-space.
#pragma once

#include <span>
#include <vector>

#include <palpate/contact/detail/half_space_field.hpp>
#include <palpate/model/detail/half_space_source.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The elements within some layers of a node, and those of their nodes that are free to move there: nodes all of whose
/// elements are in the patch, inside the body or on the same side of it. The side is what is reached from the node over
/// facets that face its way, by less than 60 degrees. Constrained nodes and nodes of other sides are not free: the
/// field of a half-space does not belong to them. Reusable for one node after another; a worker of a thread has its
/// own.
class NodePatch {
 public:
  /// Allocates 12 bytes per node and 4 per element. Keeps a reference to the source.
  explicit NodePatch(const HalfSpaceSource& source);

  /// `middle` is always free. O(nodes of the patch).
  void find(NodeId middle, const Vector3& normal);

  NodeId middle() const noexcept { return middle_; }
  /// All nodes of the elements, by layers.
  std::span<const NodeId> nodes() const noexcept { return nodes_; }
  /// Those of the first layers of elements.
  std::span<const NodeId> nodes(int layers) const noexcept {
    return std::span(nodes_).first(layer_end_[static_cast<std::size_t>(layers)]);
  }
  std::span<const NodeId> free() const noexcept { return free_; }
  /// Number of a node among the free ones, or -1.
  int index_of(NodeId node) const noexcept { return place_[static_cast<std::size_t>(node)]; }
  /// Whether a neighbour on the surface is not free.
  bool is_cut() const noexcept { return cut_; }

 private:
  void collect_elements();
  void collect_side();
  bool is_complete(NodeId node) const noexcept;
  bool may_move(NodeId node) const noexcept;
  bool faces_my_way(int triangle) const noexcept;

  const HalfSpaceSource& source_;
  NodeId middle_ = -1;
  Vector3 normal_ = Vector3::Zero();
  std::vector<int> element_seen_, node_seen_, side_seen_;  // the search that found it last
  int search_ = 0;
  std::vector<NodeId> nodes_, side_, free_;
  std::vector<std::size_t> layer_end_;
  std::vector<int> place_;
  bool cut_ = false;
};

/// The forces a(G, phi) on the free nodes of a patch under which the mesh takes the displacement nearest in energy to
/// the field G of a half-space with a unit force at the middle of the patch; G is sheared in a body that is no
/// half-space.
///
/// a(G, phi) is the integral of stress(G) : grad(phi) over the body. As G is in equilibrium outside of its force,
/// Gauss' theorem leaves integrals over faces: for other nodes than the middle, of phi times the traction over the
/// boundary; for the middle, of (phi - 1) times the traction over its own facets and over the faces opposite to it,
/// where phi is 0. All are finite. On a plane this is a unit force on the middle, without any quadrature; at an edge of
/// 90 degrees a unit force would make contact forces wrong by 38 %.
class HalfSpaceLoad {
 public:
  /// Keeps a reference to the source. One per thread.
  explicit HalfSpaceLoad(const HalfSpaceSource& source);

  /// Writes the forces per unit force, three rows per free node and a column per direction.
  void compute(const NodePatch& patch, const HalfSpaceField& field, const Vector3& normal, MatrixX& load);

 private:
  bool is_flat(const BoundaryFace& face) const noexcept;
  void add_boundary_face(const BoundaryFace& face);
  void add_own_load();
  template <class Nodes, class Add>
  void for_each_traction(const Nodes& nodes, const FaceRule& rule, Add&& add) const;

  const HalfSpaceSource& source_;
  std::vector<int> face_seen_;  // the load that has it last
  int number_ = 0;
  // of the present load
  const NodePatch* patch_ = nullptr;
  const HalfSpaceField* field_ = nullptr;
  MatrixX* load_ = nullptr;
  Vector3 middle_ = Vector3::Zero(), normal_ = Vector3::Zero();
  double tolerance_ = 0.0;
};

/// The blocks below the diagonal of a BlockMatrix, found by column: with them a whole row can be read. 12 bytes per
/// block.
class ColumnBlocks {
 public:
  struct Block {
    NodeId row;
    Index position;
  };
  explicit ColumnBlocks(const BlockPattern& pattern);
  std::span<const Block> of(NodeId column) const noexcept {
    const auto i = static_cast<std::size_t>(column);
    return {block_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
  }

 private:
  std::vector<Index> first_;
  std::vector<Block> block_;
};

/// Whether the components that are prescribed, a bit each, have more than half of the normal.
inline bool is_fixed_along(const Vector3& normal, std::uint8_t components) noexcept {
  double part = 0.0;
  for (int c = 0; c < 3; ++c)
    if ((components >> c & 1) != 0) part += normal[c] * normal[c];
  return part > 0.5;
}

/// The compliance of a touched vertex to the force on the vertex in the middle of a patch.
struct PatchEntry {
  int vertex;
  Matrix3 compliance;  ///< times the shear modulus [1/m]
};

/// Worker of one thread. K_ff g = load - K_fb G_b, where f are the free nodes of a patch, b all other nodes that the
/// stiffness couples to them, G_b the field of the half-space there.
class PatchProjection {
 public:
  /// Keeps references.
  PatchProjection(const HalfSpaceSource& source, const ColumnBlocks& columns);

  /// Fills `entries` with the touched vertices among the free nodes, by vertex, and sets marks. Leaves it empty
  /// above a support that is too near, and when there is no solution: a pivot that is not positive, or a residual above
  /// 1e-8.
  void solve(int vertex, const Vector3& normal, std::vector<PatchEntry>& entries, HalfSpaceMarks& marks);
  /// Elements between the middle of the last patch and the surface on the other side of the body, where that is free to
  /// move; 0 where it is farther away than the patch.
  int layers_across() const noexcept { return layers_across_; }

 private:
  void assemble(const UniformStiffness& stiffness, const HalfSpaceField& field);
  void release_cut_domains(const UniformStiffness& stiffness, const HalfSpaceField& field);
  void release(int domain, double bulk, const Vector3& mean_stress, const HalfSpaceField& field);
  double support_below(NodeId middle, const Vector3& normal) const noexcept;
  double depth_below(NodeId node, NodeId middle, const Vector3& normal) const noexcept;
  bool is_free_side_below(NodeId node, NodeId middle, const Vector3& normal) const noexcept;
  int count_layers(NodeId middle, const Vector3& normal) const noexcept;
  bool solve_dense();
  const Matrix3& boundary_value(NodeId node, const HalfSpaceField& field);

  const HalfSpaceSource& source_;
  const ColumnBlocks& columns_;
  NodePatch patch_;
  HalfSpaceLoad load_;
  MatrixX matrix_, right_, solution_;
  VectorX b_, x_;
  std::vector<int> known_;  // per node, the patch for which its boundary value is known, and where that is
  std::vector<int> value_of_;
  std::vector<Matrix3> values_;
  int number_ = 0;
  int layers_across_ = 0;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/patch_projection.ipp>
#endif
