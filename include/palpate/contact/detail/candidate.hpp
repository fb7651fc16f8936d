// A contact point near the sphere of a tool.
#pragma once

#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/core/types.hpp>

#include <cstdint>

namespace palpate { inline namespace PALPATE_ABI {

/// Normals of a row in the last linearisation and the one before: those used, and those that resulted.
struct NormalHistory {
  Vector3 used = Vector3::Zero(), used_before = Vector3::Zero(), made_before = Vector3::Zero();
  int known = 0;  ///< number of consecutive linearisations, at most 2
};

/// A contact point near the sphere of one tool, as of its last evaluation.
struct Candidate {
  int sample = 0;
  int triangle = 0;
  int tool = 0;
  int row = -1;                        ///< of the contact problem, -1 when it has none
  int slot = -1;                       ///< slot of its compliance in the last use
  bool facing = true;                  ///< the sphere is on the outer side
  bool evaluated = true;               ///< false: of gap, point, normal and core only a lower bound of the gap is known
  double gap = 0.0;                    ///< [m]
  double seen = 0.0;                   ///< travel of sphere and surface at the last evaluation [m]
  double force = 0.0;                  ///< of the last solution [N]
  Vector3 point = Vector3::Zero();     ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();    ///< unit, from the point to the closest point of the tool's core
  Vector3 core = Vector3::Zero();      ///< that point, in the tool's own frame [m]; zero for a sphere
  Vector3 moved_to = Vector3::Zero();  ///< its place in `generation` of the displacement [m]
  std::uint64_t generation = 0;        ///< 0: not known
  NormalHistory history;

  Vector3 friction = Vector3::Zero();  ///< of the last solution, on the tool [N]
  Vector3 anchor = Vector3::Zero();    ///< stick anchor on the tool after the last tick, tool's own frame [m]
  std::uint64_t stuck_tick = 0;        ///< the tick after which it stuck
  bool grasped = false;                ///< a grasped point, not one found near a sphere
  double area = 0.0;                   ///< of the surface that the point stands for at present [m^2]

  /// Removes its force, friction and history.
  void lift() noexcept {
    force = 0.0;
    stuck_tick = 0;
    history.known = 0;
  }
};

}}  // namespace palpate
