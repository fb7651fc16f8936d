// The load on a patch of a mesh that makes it show the field of a half-space.
#pragma once

#include <palpate/contact/detail/half_space_field.hpp>
#include <palpate/model/detail/node_patch.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

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

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/half_space_load.ipp>
#endif
