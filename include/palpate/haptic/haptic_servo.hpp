// One haptic session: tools against a tissue, one force per tool and tick.
#pragma once

#include <palpate/concepts/servo.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/sphere_tool.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/haptic/triple_buffer.hpp>

#include <optional>

namespace palpate::inline PALPATE_ABI {

/// What a session may choose.
struct ServoOptions {
  DeviceLimits device;                       ///< of the device that renders; gives the defaults below
  double rate = 1000.0;                      ///< [1/s] nominal rate of ticks
  std::optional<double> coupling_stiffness;  ///< [N/m] between proxy and device; default the device's stiffness,
                                             ///< infinity for verification
  std::optional<ForceLimits> force_limits;   ///< default ForceLimits::from(device, rate)
  ContactParameters contact;
};

/// A contact that presses, world frame.
struct ToolContact {
  int tool = 0;
  Vector3 point = Vector3::Zero();   ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();  ///< unit, from the surface to the ball's centre
  double force = 0.0;                ///< of the tissue on the ball along the normal, before the gate [N]
};

/// Contact state and force gate of one session. `tick` computes the force in the tick that brought the pose and passes
/// it through the gate: no way to the device goes round it. Refers to the tissue, which must outlive it; neither copied
/// nor moved.
template <TissueModel Tissue>
class HapticServo {
 public:
  static constexpr std::size_t max_tools = maximum_tools;
  static constexpr int contact_capacity = 64;  ///< contacts of all tools; more are left out (degraded_model)

  /// What a renderer needs of a tick: forces on the contact surface, contacts and proxies of the tools in the world.
  struct Snapshot {
    std::array<VertexForce, 3 * contact_capacity> forces;
    std::size_t force_count = 0;
    std::array<ToolContact, contact_capacity> contacts;
    std::size_t contact_count = 0;
    std::array<Vector3, max_tools> proxies{};  ///< centre of every tool's ball, world frame [m]
    double time = 0.0;
    std::span<const VertexForce> vertex_forces() const noexcept { return {forces.data(), force_count}; }
    std::span<const ToolContact> tool_contacts() const noexcept { return {contacts.data(), contact_count}; }
  };

  /// Throws bad_argument for an invalid tool, coupling or limits, or when nothing of the tissue can be touched.
  /// Allocates all a tick needs.
  HapticServo(Tissue& tissue, const SphereTool& tool, const ServoOptions& options = {})
      : HapticServo(tissue, std::vector<SphereTool>{tool}, options) {}
  HapticServo(Tissue& tissue, const std::vector<SphereTool>& tools, const ServoOptions& options = {})
      : tissue_(&tissue),
        problem_(tissue.contact_surface(), smallest_radius(tools), options.contact),
        contact_tools_(tools.size()),
        states_(tools.size()),
        forces_(tools.size()) {
    if (tissue.contact_surface().triangles().empty())
      raise(SetupErrorKind::bad_argument, "nothing of this tissue can be touched",
            "Name a surface group with Scene::touch");
    if constexpr (requires { tissue.require_tools(0.0, options.contact); })
      tissue.require_tools(smallest_radius(tools), options.contact);
    const double stiffness = options.coupling_stiffness.value_or(options.device.stiffness);
    if (!(stiffness > 0.0))
      raise(SetupErrorKind::bad_argument, "the coupling stiffness is " + number(stiffness),
            "It must be positive, in N/m; infinity is allowed");
    const ForceLimits limits = options.force_limits.value_or(ForceLimits::from(options.device, options.rate));
    for (std::size_t i = 0; i < tools.size(); ++i) {
      contact_tools_[i].radius = tools[i].radius;
      contact_tools_[i].compliance = 1.0 / stiffness;
      gates_.emplace_back(limits);
    }
  }
  HapticServo(Tissue&&, const SphereTool&, const ServoOptions& = {}) = delete;
  HapticServo(const HapticServo&) = delete;
  HapticServo& operator=(const HapticServo&) = delete;

  /// One tick: a force for every tool, in order; the span is valid until the next tick. States beyond the number of
  /// tools are ignored, missing ones count as unreadable. Never throws, allocates, locks or waits; bounded by contact
  /// capacity and iterations.
  std::span<const ToolForce> tick(std::span<const ToolState> states) noexcept {
    const FlushDenormals flush;
    Status shared;
    if constexpr (MovesByItself<Tissue>) shared |= tissue_->begin_tick();
    if constexpr (requires { tissue_->exchange_contacts(problem_); }) tissue_->exchange_contacts(problem_);
    for (std::size_t i = 0; i < states_.size(); ++i) read(i, i < states.size() ? states[i] : unreadable());
    shared |= problem_.solve(*tissue_, contact_tools_);
    for (std::size_t i = 0; i < states_.size(); ++i) recover(i);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const Vector3 wanted =
          contact_tools_[i].active ? Vector3(tissue_->pose().linear() * contact_tools_[i].force) : Vector3::Zero();
      const Input& input = states_[i];
      forces_[i] = gates_[i].apply(wanted, input.time, input.time, input.readable, input.restarted);
      forces_[i].status |= input.status | shared;
    }
    if constexpr (requires { tissue_->end_tick(problem_.vertex_forces()); })
      tissue_->end_tick(problem_.vertex_forces());
    publish();
    return forces_;
  }

  /// Lifts all tools, tells the tissue that nothing presses, and closes the gates; the next tick starts anew with the
  /// ramp. For the tick's own thread.
  void reset() noexcept {
    problem_.clear();
    for (Input& input : states_) input = Input{};
    for (ContactTool& tool : contact_tools_) {
      tool.active = false;
      tool.force.setZero();
    }
    for (ForceGate& gate : gates_) gate.reset();
    if constexpr (requires { tissue_->end_tick(problem_.vertex_forces()); })
      tissue_->end_tick(std::span<const VertexForce>());
  }

  /// Contacts of the last tick, model frame. For the tick's own thread.
  std::span<const Contact> contacts() const noexcept { return problem_.contacts(); }
  /// Where the ball rests on the surface, world frame [m]. For the tick's own thread.
  Vector3 proxy(std::size_t tool = 0) const noexcept { return tissue_->pose() * contact_tools_[tool].proxy; }
  /// Contact force before the gate, world frame [N]. For the tick's own thread.
  Vector3 contact_force(std::size_t tool = 0) const noexcept {
    return tissue_->pose().linear() * contact_tools_[tool].force;
  }

  /// Newest snapshot, for one reader thread; never waits. Valid until the next call.
  const Snapshot& read_snapshot() noexcept {
    snapshots_.update();
    return snapshots_.front();
  }

 private:
  struct Input {
    Vector3 position = Vector3::Zero();  // last good one, model frame
    double time = 0.0;
    bool known = false;  // position is valid
    bool readable = false;
    bool restarted = false;
    Status status;
  };

  static double smallest_radius(const std::vector<SphereTool>& tools) {
    if (tools.empty() || tools.size() > max_tools)
      raise(SetupErrorKind::bad_argument,
            "a servo has one to " + std::to_string(max_tools) + " tools, not " + std::to_string(tools.size()));
    for (const SphereTool& tool : tools) tool.require_valid();
    return std::ranges::min_element(tools, {}, &SphereTool::radius)->radius;
  }
  static ToolState unreadable() noexcept {
    ToolState s;
    s.valid = false;
    return s;
  }

  /// Takes in one tool's state: decides whether it is readable, finite, continuous with the last, and acquires the
  /// surface if not.
  void read(std::size_t i, const ToolState& state) noexcept {
    Input& input = states_[i];
    ContactTool& tool = contact_tools_[i];
    input.status = {};
    input.readable = state.valid;
    input.restarted = false;
    tool.motion.setZero();
    if (!state.valid) {
      tool.active = input.known = false;
      tool.force.setZero();
      return;
    }
    const Vector3 position = tissue_->pose().inverse() * state.position;
    // Beyond this no workspace reaches, and squares keep clear of overflow.
    const bool finite = position.allFinite() && position.cwiseAbs().maxCoeff() < 1e6 && std::isfinite(state.time);
    if (!finite) {
      // The last good pose is held; its old time stamp makes the gate fade the force.
      input.status.set(StatusFlag::non_finite_input);
      input.readable = input.known;
      return;
    }
    input.time = state.time;
    const Vector3 motion = position - input.position;
    if (input.known && motion.norm() > 2.0 * tool.radius) {
      input.known = false;
      input.status.set(StatusFlag::reacquired);
    }
    if (!input.known) {
      acquire(tool, position);
      input.restarted = true;
    } else {
      tool.motion = motion;
    }
    input.position = tool.target = position;
    input.known = tool.active = true;
  }

  /// Puts the proxy where the ball does not touch the resting surface: at the target if it is free there, else next to
  /// the closest point.
  void acquire(ContactTool& tool, const Vector3& position) noexcept {
    const auto closest = tissue_->contact_surface().closest(position);
    tool.force.setZero();
    tool.proxy = closest.distance >= tool.radius ? position : Vector3(closest.point + tool.radius * closest.outward);
  }

  /// A ball whose centre is in the body without any contact has lost the surface: it is put back in the next tick, with
  /// the ramp.
  void recover(std::size_t i) noexcept {
    const ContactTool& tool = contact_tools_[i];
    if (!tool.active || !tool.force.isZero(0.0)) return;
    // Far from all contact points nothing changes fast: one look in a while is enough.
    if (!problem_.is_near(static_cast<int>(i)) && ++ticks_ % 16 != 0) return;
    if (tissue_->contact_surface().closest(tool.target).distance >= 0.0) return;
    states_[i].known = false;
    states_[i].status.set(StatusFlag::reacquired);
  }

  void publish() noexcept {
    Snapshot& s = snapshots_.back();
    const auto forces = problem_.vertex_forces();
    std::ranges::copy(forces, s.forces.begin());
    s.force_count = forces.size();
    s.contact_count = 0;
    for (const Contact& c : problem_.contacts())
      if (c.force > 0.0)
        s.contacts[s.contact_count++] = {c.tool, tissue_->pose() * c.point, tissue_->pose().linear() * c.normal,
                                         c.force};
    for (std::size_t i = 0; i < contact_tools_.size(); ++i) s.proxies[i] = proxy(i);
    s.time = states_.front().time;
    snapshots_.publish();
  }

  Tissue* tissue_;
  ContactProblem<contact_capacity> problem_;
  std::vector<ContactTool> contact_tools_;
  std::vector<Input> states_;
  std::vector<ForceGate> gates_;
  std::vector<ToolForce> forces_;
  TripleBuffer<Snapshot> snapshots_;
  unsigned ticks_ = 0;
};

}  // namespace palpate::inline PALPATE_ABI
