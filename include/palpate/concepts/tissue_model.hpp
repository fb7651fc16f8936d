// Concept of a tissue that a haptic session can touch.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Geometry>

#include <concepts>
#include <cstdint>
#include <span>
#include <type_traits>

namespace palpate { inline namespace PALPATE_ABI {

class ContactProblem;
struct ContactParameters;
struct ToolRadii;
struct BladeSweep;

/// Return type of a hook that does nothing; such a hook is never called.
struct NoHook {};

/// Result of one step of background work.
struct BackgroundStep {
  bool worked = false;  ///< false: there was nothing to do
  double next = 0.0;    ///< [s] from the due time of this step to that of the next; 0: immediately
};

namespace detail {

template <class R, class Expected>
concept HookResult = std::same_as<R, NoHook> || std::same_as<R, Expected>;

template <class T>
concept HasSurface = requires(T& tissue, const T& constant, std::span<const int> vertices) {
  { constant.contact_surface().vertex_count() } noexcept -> std::convertible_to<int>;
  { tissue.require_columns(vertices) } noexcept -> std::same_as<Status>;
  { constant.to_world() } noexcept -> std::same_as<const Eigen::Isometry3d&>;
};
template <class T>
concept HasCompliance = requires(const T& constant, int i) {
  { constant.compliance(i, i) } noexcept -> FixedExpression<3, 3>;
};
template <class T>
concept HasComplianceScales = requires(const T& constant, int i) {
  { constant.compliance_revision() } noexcept -> std::convertible_to<std::uint64_t>;
  { constant.compliance_bound(i) } noexcept -> std::convertible_to<double>;
  { constant.compliance_floor() } noexcept -> std::convertible_to<double>;
};

template <class T>
concept HasPrefetch = requires(T& tissue, std::span<const int> vertices) {
  { tissue.prefetch(vertices) } noexcept -> HookResult<void>;
};
template <class T>
concept HasBeginTick = requires(T& tissue) {
  { tissue.begin_tick() } noexcept -> HookResult<Status>;
};
template <class T>
concept HasEndTick = requires(T& tissue, std::span<const VertexForce> forces,
                              std::span<const PointForce> points) {
  { tissue.end_tick(forces, points) } noexcept -> HookResult<void>;
};
template <class T>
concept HasUpdates = requires(const T& constant) {
  { constant.updates() } noexcept -> HookResult<std::uint64_t>;
};
template <class T>
concept HasExchangeContacts = requires(T& tissue, ContactProblem& problem) {
  { tissue.exchange_contacts(problem) } noexcept -> HookResult<void>;
};
template <class T>
concept HasPrepareTools = requires(T& tissue, const ToolRadii& radii, const ContactParameters& parameters) {
  { tissue.prepare_tools(radii, parameters) } -> HookResult<void>;
};
template <class T>
concept HasTryCut = requires(T& tissue, const BladeSweep& sweep) {
  { tissue.try_cut(sweep) } noexcept -> HookResult<bool>;
};
template <class T>
concept HasHalfSpaceMap = requires(const T& constant) {
  { constant.half_space_map(0) } noexcept -> HookResult<Matrix3>;
};
template <class T>
concept HasWorkHooks = requires(T& tissue, bool is) {
  { tissue.background_work() } -> HookResult<BackgroundStep>;
  { tissue.report_slow(is) } noexcept -> HookResult<void>;
  { tissue.report_failed(is) } noexcept -> HookResult<void>;
};
template <class T>
concept HasHooks = HasPrefetch<T> && HasBeginTick<T> && HasEndTick<T> && HasUpdates<T> && HasExchangeContacts<T> &&
                   HasPrepareTools<T> && HasTryCut<T> && HasHalfSpaceMap<T> && HasWorkHooks<T>;

template <class Member>
struct ClassOf;
template <class R, class C, class... A>
struct ClassOf<R (C::*)(A...) const> : std::type_identity<C> {};
template <class R, class C, class... A>
struct ClassOf<R (C::*)(A...) const noexcept> : std::type_identity<C> {};

/// Whether `Scale` is inherited from a class with its own compliance, by a class that changes the compliance.
template <class Compliance, class Scale>
concept OutOfDate = requires {
  typename ClassOf<Compliance>::type;
  typename ClassOf<Scale>::type;
  &ClassOf<Scale>::type::compliance;
} && !std::derived_from<typename ClassOf<Scale>::type, typename ClassOf<Compliance>::type>;

template <class T>
concept HasOutOfDateScale = requires { &T::compliance; } &&
                            ((requires { &T::compliance_revision; } &&
                              OutOfDate<decltype(&T::compliance), decltype(&T::compliance_revision)>) ||
                             (requires { &T::compliance_bound; } &&
                              OutOfDate<decltype(&T::compliance), decltype(&T::compliance_bound)>) ||
                             (requires { &T::compliance_floor; } &&
                              OutOfDate<decltype(&T::compliance), decltype(&T::compliance_floor)>));

/// Whether a tissue sums C_ij f_j itself, with the compliance that it has.
template <class T>
concept HasOwnDisplacement = requires(const T& constant, std::span<const VertexForce> forces) {
  { constant.displacement_of(0, forces) } noexcept -> std::same_as<Vector3>;
} && !OutOfDate<decltype(&T::compliance), decltype(&T::displacement_of)>;

/// Whether a tissue, or the one that it wraps, changes the compliance of a class from which it has its surface.
template <class T>
concept HasOutOfDateMaterials = (requires { &T::compliance; &T::contact_surface; } &&
                               OutOfDate<decltype(&T::compliance), decltype(&T::contact_surface)>) ||
                              T::wraps_changed_compliance;

/// Does not compile for a type that is not a TissueModel; the message names what is missing.
template <class T>
constexpr void explain_tissue() noexcept {
  static_assert(!std::is_const_v<T>, "palpate: a const tissue cannot be touched: ticks change it");
  if constexpr (!std::is_const_v<T>) {
    static_assert(HasSurface<T>,
                  "palpate: not a tissue: it needs contact_surface() const, require_columns(span<const int>) and "
                  "to_world() const, all noexcept (concepts/tissue_model.hpp)");
    static_assert(HasCompliance<T>,
                  "palpate: this tissue needs compliance(int, int) const noexcept, which returns 3 x 3 doubles");
    static_assert(HasComplianceScales<T>,
                  "palpate: this tissue needs compliance_revision(), compliance_bound(int) and compliance_floor(), "
                  "const noexcept");
    static_assert(!HasOutOfDateScale<T>,
                  "palpate: this tissue changes the compliance that it inherits; it must define compliance_revision(), "
                  "compliance_bound(int) and compliance_floor() as well");
#define PALPATE_HOOK(hook, call)                                                                                   \
  static_assert(hook<T>, "palpate: this tissue has no hook " call                                                   \
                         ": derive it from TissueAdaptor, which forwards the hooks of another tissue, or, if it "   \
                         "does not move, from StillTissue")
    PALPATE_HOOK(HasPrefetch, "prefetch(span<const int>) noexcept -> void or NoHook");
    PALPATE_HOOK(HasBeginTick, "begin_tick() noexcept -> Status or NoHook");
    PALPATE_HOOK(HasEndTick, "end_tick(span<const VertexForce>, span<const PointForce>) noexcept -> void or NoHook");
    PALPATE_HOOK(HasUpdates, "updates() const noexcept -> uint64_t or NoHook");
    PALPATE_HOOK(HasExchangeContacts, "exchange_contacts(ContactProblem&) noexcept -> void or NoHook");
    PALPATE_HOOK(HasPrepareTools, "prepare_tools(const ToolRadii&, const ContactParameters&) -> void or NoHook");
    PALPATE_HOOK(HasTryCut, "try_cut(const BladeSweep&) noexcept -> bool or NoHook");
    PALPATE_HOOK(HasHalfSpaceMap, "half_space_map(int) const noexcept -> Matrix3 or NoHook");
    PALPATE_HOOK(HasWorkHooks,
                 "background_work() -> BackgroundStep or NoHook, report_slow(bool) or report_failed(bool), both "
                 "noexcept -> void or NoHook");
#undef PALPATE_HOOK
  }
}

}  // namespace detail

/// A tissue that can be touched. Vertices are those of `contact_surface()`, the surface at rest without tools.
/// - `require_columns(vertices)` makes the compliance columns of these vertices available; the status reports what it
/// could not do. A tick begins with an empty list: that is when the work of a background thread is taken over.
/// - `to_world()` maps the frame of the surface to the world frame.
/// - `compliance(i, j)` is the 3 x 3 displacement [m/N] of vertex i per force on vertex j, whose column was required: a
/// matrix, or an Eigen expression that stays valid until the next `require_columns`.
/// - `compliance_revision()` changes whenever a value that `compliance` returned is no longer valid, to a number that no
/// other compliance had; it is constant for a tissue whose compliance never changes.
/// - `compliance_bound(j)` is an upper bound of the displacement [m/N] of any vertex per unit force on j.
/// - `compliance_floor()` is a tiny compliance that prevents division by zero at a fixed vertex.
/// A tissue may also have `displacement_of(i, forces)`, the sum of C_ij f_j as a Vector3, where it is faster than the
/// same sum with `compliance`. A class that changes `compliance` and inherits this function does without it.
/// A class that inherits the first four and changes `compliance` must also define the other three. If it inherits
/// `contact_surface`, too, the materials of that surface are not used.
///
/// Hooks. A tissue must have all of them, so that none is forgotten; one that returns NoHook is never called.
/// StillTissue provides all of them for a tissue that does not move; TissueAdaptor forwards all those of another
/// tissue.
/// - `prefetch(vertices)` -> void: the vertices that a tool may press soon.
/// - `begin_tick()` -> Status: before each tick; may apply motion since the last tick. The status is part of the
/// tick's.
/// - `end_tick(forces, points)` -> void: the forces on the vertices after a tick, and those on the contact points that
/// they are the sums of; empty when a session is reset.
/// - `updates()` const -> std::uint64_t: number of updates applied by `begin_tick`. A servo fades its force if this
/// number does not change for too long.
/// - `exchange_contacts(problem)` -> void: after `begin_tick`, for a tissue whose triangles change: moves the session's
/// contact problem to the new surface, where the contacts continue.
/// - `prepare_tools(radii, parameters)` -> void: called once at the start of a session; may throw to refuse
/// it.
/// - `try_cut(sweep)` -> bool: requests a cut along a BladeSweep in the world frame; false when too many requests are
/// pending. Only such a tissue accepts a BladeTool.
/// - `half_space_map(v)` const -> Matrix3: M_v, with which the displacement of the half-space below the surface
/// (SubfacetCompliance) is M_v G M_w^T f: how the surface at vertex v is rotated, and, where stretch makes it stiffer,
/// that rotation times the root of what is left.
/// - `background_work()` -> BackgroundStep: work in a background thread, called by a BackgroundWorker: time steps,
/// cuts. May throw: the worker then stops.
/// - `report_slow(slow)` -> void: reports whether a BackgroundWorker cannot keep up.
/// - `report_failed(failed)` -> void: reports whether a BackgroundWorker has stopped because `background_work` threw;
/// `begin_tick` then reports stalled_tissue.
/// A tissue may also have `claim()`, if only one servo at a time can use it (TissueClaim), `notes() const`, sentences
/// for the report of a session as std::vector<std::string>, `refuses_suspicious_units() const`: whether tools that look
/// as if they were given in millimetres are refused, `can_be_cut() const noexcept`, where only some objects of the
/// type with `try_cut` can, and `gains_pieces() const noexcept`: whether the surface may be empty at first, and
/// `exchange_contacts` makes it larger.
/// All hooks but prepare_tools and background_work are noexcept, allocate nothing and take bounded time. Between two
/// calls of `begin_tick` the surface stays at the same place in memory.
template <class T>
concept TissueModel = detail::HasSurface<T> && detail::HasCompliance<T> && detail::HasComplianceScales<T> &&
                      !detail::HasOutOfDateScale<T> && detail::HasHooks<T>;

/// A tissue whose surface or compliance changes between ticks, and which announces this in `begin_tick`.
template <class T>
concept AnnouncesChanges = requires(T& tissue) {
  { tissue.begin_tick() } -> std::same_as<Status>;
};

/// A tissue with work to do in a background thread.
template <class T>
concept HasBackgroundWork = requires(T& tissue) {
  { tissue.background_work() } -> std::same_as<BackgroundStep>;
};

}}  // namespace palpate
