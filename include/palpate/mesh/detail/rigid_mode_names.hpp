// Names of rigid motions.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Up to six rigid motions (w, t).
using RigidMotions = std::vector<Vector6>;

inline Vector3 rotation_of(const Vector6& motion) noexcept {
  return {motion[0], motion[1], motion[2]};
}
inline Vector3 shift_of(const Vector6& motion) noexcept {
  return {motion[3], motion[4], motion[5]};
}

/// One name per motion: translations first, then rotations, each about its own axis.
std::vector<std::string> name_rigid_motions(const RigidMotions& motions, const Vector3& centre, double size);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/rigid_mode_names.ipp>
#endif
