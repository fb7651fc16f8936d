// Whether the linear surroundings of a part at large strain are displaced by too much for linear elasticity.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/body_parts.hpp>
#include <palpate/model/moving/detail/linear_surroundings.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Estimates the largest displacement of a far part, up to a translation, without computing it: from its loads, from
/// the spread of the interface and of the supports, and from the rotation of the interface, which a part that hangs on
/// it follows. Only the constructor allocates.
class FarDisplacement {
 public:
  /// `positions` of the body at rest [m]; displacements above `largest` [m] are too large.
  FarDisplacement(const BodyParts& parts, const std::vector<Vector3>& positions, LinearSurroundings& surroundings,
                  double largest);

  /// Takes over the displacement of the far part by its loads alone, 3 per node of the part [m].
  void set_from_load(const VectorX& u) noexcept;
  /// Whether a displacement of the body, 3 per node [m], displaces its far part by too much. Reads the interface and
  /// the prescribed components.
  bool is_too_large(const VectorX& u) noexcept;

 private:
  struct Support {
    NodeId node;  // of the body
    std::uint8_t constrained;
  };
  std::vector<NodeId> interface_;
  std::vector<Vector3> arm_;  // of the interface, from its centre
  Matrix3 inverse_inertia_ = Matrix3::Zero();
  Vector3 reach_ = Vector3::Zero();  // largest displacement of the far part per rotation of the interface [m]
  std::vector<Support> supports_;
  std::vector<Vector3> displaced_, loaded_;
  double largest_;
  bool loads_displace_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/far_displacement.ipp>
#endif
