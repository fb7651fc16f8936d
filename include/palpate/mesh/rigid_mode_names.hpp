// Rigid motions in words.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Up to six rigid motions (w, t), one per column. Bounded at compile time: nothing to allocate, little to compile.
using RigidMotions = Eigen::Matrix<double, 6, Eigen::Dynamic, 0, 6, 6>;

/// One name per column (w, t) of `motions`: translations first, then rotations, each about its own axis.
std::vector<std::string> name_rigid_motions(const RigidMotions& motions, const Vector3& centre, double size);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/rigid_mode_names.ipp>
#endif
