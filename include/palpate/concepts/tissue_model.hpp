// What a haptic session needs of a tissue.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Geometry>

#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// A force on one vertex of the touchable surface, model frame.
struct VertexForce {
  int vertex = -1;
  Vector3 force = Vector3::Zero();  ///< on the tissue [N]
};

/// A tissue that can be touched. Vertices are those of `contact_surface()`, the surface as it rests without tools.
/// - `require_columns(vertices)` makes the compliance columns of these vertices available; what it could not do is in
/// the status.
/// - `compliance(i, j)` is the 3 x 3 displacement [m/N] of vertex i per force on vertex j, whose column was required: a
/// matrix, or an Eigen expression that stays valid until the next `require_columns`.
/// - `compliance_revision()` is another number when a value that `compliance` has given is no longer right; constant for
/// a tissue whose compliance never changes.
/// - `compliance_bound(j)` is at least the largest displacement [m/N] of any vertex per unit force on j.
/// - `compliance_floor()` is a tiny compliance that keeps a fixed vertex from dividing by zero.
/// - `foresee(vertices)`, if there is one, is told which vertices a tool may press soon.
/// - `begin_tick()`, if there is one, is called before each tick and may bring in what moved since; its Status is part of
/// the tick's. `end_tick(forces)`, if there is one, is told the forces on the vertices after it, and that there are none
/// when a session is reset.
/// - `updates()`, if there is one, counts what `begin_tick` has brought in: a servo fades its force when that stands
/// still for too long.
/// - `exchange_contacts(problem)`, if there is one, is called after `begin_tick`, for a tissue whose triangles change: it
/// moves the session's contact problem to the new surface, where it goes on. `prepare_tools(smallest_radius, parameters)`
/// is called once by a session that begins, and may refuse it.
/// - `try_cut(sweep)`, if there is one, orders a cut along a BladeSweep in the world's frame; false when too many wait.
/// Only such a tissue takes a BladeTool.
/// - `to_world()` maps the frame of the surface to the world's.
/// All are noexcept, allocate nothing and take bounded time. Between two calls of `begin_tick` the surface stays at the
/// same place in memory.
template <class T>
concept TissueModel = requires(T& tissue, const T& constant, int i, std::span<const int> vertices) {
  { constant.contact_surface().vertex_count() } noexcept -> std::convertible_to<int>;
  { tissue.require_columns(vertices) } noexcept -> std::same_as<Status>;
  { constant.compliance(i, i) } noexcept -> FixedExpression<3, 3>;
  { constant.compliance_revision() } noexcept -> std::convertible_to<std::uint64_t>;
  { constant.compliance_bound(i) } noexcept -> std::convertible_to<double>;
  { constant.compliance_floor() } noexcept -> std::convertible_to<double>;
  { constant.to_world() } noexcept -> std::same_as<const Eigen::Isometry3d&>;
};

/// A tissue whose surface or compliance changes between ticks, and which says so before each.
template <class T>
concept AnnouncesChanges = requires(T& tissue) {
  tissue.begin_tick();
};

/// What a piece of background work was.
struct BackgroundStep {
  bool worked = false;  ///< false: there was nothing to do
  double next = 0.0;    ///< [s] from when this piece was due to when the next is; 0: at once
};

/// A tissue with work to do beside the ticks, which a BackgroundWorker does: steps of a motion, cuts.
template <class T>
concept HasBackgroundWork = requires(T& tissue) {
  { tissue.background_work() } -> std::same_as<BackgroundStep>;
};

}}  // namespace palpate
