// One haptic session: tools against a tissue, one force per tool and tick.
#pragma once

#include <palpate/concepts/haptic_device.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/haptic/servo_options.hpp>
#include <palpate/haptic/servo_snapshot.hpp>
#include <palpate/haptic/tick_view.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

struct Hand;
struct SharedTools;
class TouchedTissue;
const SharedTools& shared_tools() noexcept;

}  // namespace detail

/// Contact state of one session, and a force gate per tool. `tick` computes the force in the tick that received the
/// pose and passes it through the gate; no other path leads to the device. A TissueGroup in place of a tissue: the
/// force is that of all its tissues together, and status flags are those of the tissues that a tool presses, or of all
/// where it presses none. Refers to the tissues, which must outlive it; neither copied nor moved. An EnergyTank given
/// as last argument is used in place of those of ServoOptions::limit_energy, for other EnergyLimits. One class for
/// tissues of all types: it refers to its tissues through TissueView. With a HapticDevice, HapticSession is simpler.
class HapticServo {
 public:
  static constexpr std::size_t max_tools = maximum_tools;
  using Snapshot = ServoSnapshot;
  using Energy = std::optional<EnergyTank>;

  /// Throws bad_argument for an invalid tool, coupling or limits, a group without tissues or with one twice, or when a
  /// tissue has no touchable surface; unsupported (ids: the tool) for a BladeTool and no tissue that can be cut, and
  /// for a tissue that moves or is cut while another servo uses it; suspicious_units (ids: the tool) for a tool of more
  /// than a metre, if the tissue refuses such (AdmissionPolicy::units): otherwise it is noted. Allocates everything
  /// that a tick needs.
  template <class T>
  requires(!std::same_as<std::remove_cv_t<T>, TissueGroup> && !std::same_as<std::remove_cv_t<T>, TissueView>)
      HapticServo(T& tissue, const ToolList& tools, const ServoOptions& options = {}, const Energy& energy = {})
      : HapticServo(TissueView(tissue), tools, options, energy) {}
  HapticServo(const TissueView& tissue, const ToolList& tools, const ServoOptions& options = {},
              const Energy& energy = {})
      : HapticServo(GroupMember{tissue}, tools, options, energy) {}
  HapticServo(const TissueGroup& tissues, const ToolList& tools, const ServoOptions& options = {},
              const Energy& energy = {})
      : HapticServo(tissues.members(), tools, options, energy, &detail::shared_tools()) {}
  template <class T>
  requires(!std::is_lvalue_reference_v<T> && TissueModel<T>)
      HapticServo(T&&, const ToolList&, const ServoOptions& = {}, const Energy& = {})
  = delete;
  ~HapticServo();
  HapticServo(const HapticServo&) = delete;
  HapticServo& operator=(const HapticServo&) = delete;

  /// One tick: a force for every tool, in order; the span is valid until the next tick. States beyond the number of
  /// tools are ignored, missing ones count as unreadable. In a callback without a haptic loop set ToolState::now, so
  /// that old poses fade the force. Never throws, allocates, locks or waits; bounded by contact capacity, iterations,
  /// tissues and, when a list of points near the tools is rebuilt, the points in their reach.
  std::span<const GatedForce> tick(std::span<const ToolState> states) noexcept;
  /// The same for a session with one tool: its force, valid until the next tick.
  const GatedForce& tick(const ToolState& state) noexcept { return tick({&state, 1}).front(); }

  /// Back to the state after construction, except the heat of the motors: the same states give bitwise equal results
  /// again, if the tissue has been reset too. Not bitwise where background threads deliver at other times (asynchronous
  /// columns, renewed factors, those after a cut of moving tissue, a BackgroundWorker), and where columns were replaced
  /// (fewer SetupOptions::compliance_slots than touched vertices): that changes forces by rounding, with an iterative
  /// solver by its tolerance. Reports to the tissue and the reader of snapshots that nothing presses.
  /// For the tick's own thread.
  void reset() noexcept;
  /// Reports to the tissue that nothing presses any more, after the last tick; contacts and snapshot stay. For the
  /// tick's own thread.
  void release() noexcept;

  // Any thread, also while another one ticks

  /// Changes Coulomb's coefficient of a tissue within 0.1 s; `reset` keeps it. Throws bad_argument for one outside 0 to
  /// 4, index_out_of_range for a tissue that does not exist, and unsupported where it was zero at construction: without
  /// friction a servo has no room for it.
  void set_friction(double coefficient, std::size_t tissue = 0);
  double friction(std::size_t tissue = 0) const noexcept;
  /// Changes the stiffness of the coupling of a tool within 0.1 s [N/m]. Throws bad_argument for a stiffness that the
  /// constructor refuses, index_out_of_range for a tool that does not exist, unsupported for a blade.
  void set_coupling_stiffness(double stiffness, std::size_t tool = 0);
  double coupling_stiffness(std::size_t tool = 0) const noexcept;

  // The thread that ticks

  /// What the last tick computed: contacts, proxies, forces before the gate and their errors. For the tick's own
  /// thread.
  TickView tick_view() const& noexcept;
  TickView tick_view() const&& = delete;

  std::size_t tissue_count() const noexcept;
  /// The facets of a tissue that are too long for the smallest tool, on the surface at construction.
  const CoarseFacetReport& coarse_facets(std::size_t tissue = 0) const noexcept;
  /// What the set-up of the tissue reported, and which tools look as if they were given in millimetres.
  const std::vector<std::string>& notes() const noexcept { return notes_; }
  /// Limits of a tool's gate.
  const ForceLimits& limits(std::size_t tool = 0) const noexcept;

  /// Newest snapshot, for one reader thread; never waits. Valid until the next call.
  const Snapshot& read_snapshot() noexcept {
    snapshots_.update();
    return snapshots_.front();
  }

 private:
  friend class HapticSession;
  using Members = std::span<const GroupMember>;
  HapticServo(const GroupMember& member, const ToolList& tools, const ServoOptions& options, const Energy& energy)
      : HapticServo(Members(&member, 1), tools, options, energy, nullptr) {}
  HapticServo(Members members, const ToolList& tools, const ServoOptions& options, const Energy& energy,
              const detail::SharedTools* shared);

  void check_units();
  void check_blades() const;
  detail::Hand make_hand(std::size_t i, const ServoOptions& options, const Energy& energy);
  void follow_parameters() noexcept;
  void receive(std::span<const ToolState> states) noexcept;
  void solve() noexcept;
  void recover() noexcept;
  void add_errors(detail::Hand& hand, const Vector3& force) noexcept;
  bool is_pressed(std::size_t tool) const noexcept;
  Status status_of(std::size_t tool) noexcept;
  double time_of(std::size_t tool) const noexcept;
  void pass(detail::Hand& hand) noexcept;
  void publish() noexcept;

  ToolList tools_;  // owns the shapes of convex tools
  std::vector<detail::TouchedTissue> tissues_;
  const detail::SharedTools* shared_;  // null for one tissue
  std::vector<std::string> notes_;
  std::vector<GatedForce> forces_;
  std::vector<detail::Hand> hands_;  // refer to forces
  double stale_tissue_after_, force_tolerance_;
  int ramp_ticks_;  // of parameters that change
  bool corrected_force_;
  TripleBuffer<Snapshot> snapshots_;
  const Snapshot* newest_ = &snapshots_.back();  // published last; not written before the next is published
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/haptic_servo.ipp>
#endif
