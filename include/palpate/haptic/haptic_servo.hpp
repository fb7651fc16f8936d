// One haptic session: tools against a tissue, one force per tool and tick.
#pragma once

#include <palpate/concepts/servo.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/haptic/servo_options.hpp>
#include <palpate/haptic/servo_snapshot.hpp>
#include <palpate/haptic/tool_input.hpp>
#include <palpate/haptic/triple_buffer.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Contact state and force gate of one session. `tick` computes the force in the tick that brought the pose and passes
/// it through the gate: no way to the device goes round it. Refers to the tissue, which must outlive it; neither copied
/// nor moved. `Energy` limits what the tool may be given: NoEnergyTank, or an EnergyTank given as last argument.
template <TissueModel Tissue, class Energy = NoEnergyTank>
class HapticServo {
 public:
  static constexpr std::size_t max_tools = maximum_tools;
  /// Contacts of all tools; more are left out (degraded_model).
  static constexpr int contact_capacity = default_contact_capacity;
  using Snapshot = ServoSnapshot<contact_capacity>;

  /// Throws bad_argument for an invalid tool, coupling or limits, or when nothing of the tissue can be touched.
  /// Allocates all a tick needs.
  HapticServo(Tissue& tissue, const SphereTool& tool, const ServoOptions& options = {}, const Energy& energy = Energy())
      : HapticServo(tissue, std::vector<CapsuleTool>{tool}, options, energy) {}
  HapticServo(Tissue& tissue, const CapsuleTool& tool, const ServoOptions& options = {},
              const Energy& energy = Energy())
      : HapticServo(tissue, std::vector<CapsuleTool>{tool}, options, energy) {}
  HapticServo(Tissue& tissue, const std::vector<SphereTool>& tools, const ServoOptions& options = {},
              const Energy& energy = Energy())
      : HapticServo(tissue, std::vector<CapsuleTool>(tools.begin(), tools.end()), options, energy) {}
  HapticServo(Tissue& tissue, const std::vector<CapsuleTool>& tools, const ServoOptions& options = {},
              const Energy& energy = Energy())
      : tissue_(&tissue),
        contact_tools_(make_contact_tools(tools, options)),
        problem_(tissue.contact_surface(), smallest_radius(contact_tools_), options.contact),
        energies_(tools.size(), energy),
        forces_(tools.size()),
        stale_tissue_after_(options.stale_tissue_after) {
    if (tissue.contact_surface().triangles().empty())
      raise(SetupErrorKind::bad_argument, "nothing of this tissue can be touched",
            "Name a surface group with Scene::touch");
    if constexpr (requires { tissue.require_tools(0.0, options.contact); })
      tissue.require_tools(smallest_radius(contact_tools_), options.contact);
    if (!(options.stale_tissue_after > 0.0))
      raise(SetupErrorKind::bad_argument, "stale_tissue_after is " + number(options.stale_tissue_after),
            "It must be positive, in seconds; infinity is allowed");
    const ForceLimits limits = options.limits();
    gates_.assign(tools.size(), ForceGate(limits));
    for (const CapsuleTool& tool : tools)
      inputs_.emplace_back(static_cast<int>(inputs_.size()), tool.half_length > 0.0 || limits.peak_torque > 0.0,
                           options.grasp_buttons);
  }
  HapticServo(Tissue&&, const SphereTool&, const ServoOptions& = {}) = delete;
  HapticServo(const HapticServo&) = delete;
  HapticServo& operator=(const HapticServo&) = delete;

  /// One tick: a force for every tool, in order; the span is valid until the next tick. States beyond the number of
  /// tools are ignored, missing ones count as unreadable. Never throws, allocates, locks or waits; bounded by contact
  /// capacity, iterations and, when a list of points near the tools is made anew, the points in their reach.
  std::span<const ToolForce> tick(std::span<const ToolState> states) noexcept {
    const FlushDenormals flush;
    ++ticks_;
    Status shared;
    if constexpr (AnnouncesChanges<Tissue>) shared |= tissue_->begin_tick();
    if constexpr (requires { tissue_->exchange_contacts(problem_); }) tissue_->exchange_contacts(problem_);
    for (std::size_t i = 0; i < inputs_.size(); ++i) take(i, i < states.size() ? states[i] : unreadable());
    note_updates();
    shared |= problem_.solve(*tissue_, contact_tools_);
    for (std::size_t i = 0; i < inputs_.size(); ++i) recover(i);
    for (std::size_t i = 0; i < inputs_.size(); ++i) pass(i, shared);
    if constexpr (requires { tissue_->end_tick(problem_.vertex_forces()); })
      tissue_->end_tick(problem_.vertex_forces());
    publish();
    return forces_;
  }

  /// Lifts all tools, tells the tissue and the reader of snapshots that nothing presses, and closes the gates; the next
  /// tick starts anew with the ramp. For the tick's own thread.
  void reset() noexcept {
    problem_.clear();
    started_ = false;
    for (ToolInput& input : inputs_) input.reset();
    for (ContactTool& tool : contact_tools_) tool.lift();
    for (ForceGate& gate : gates_) gate.reset();
    if constexpr (requires { tissue_->end_tick(problem_.vertex_forces()); })
      tissue_->end_tick(std::span<const VertexForce>());
    for (Energy& energy : energies_) energy.reset();
    publish();
  }

  /// Contacts of the last tick, model frame. For the tick's own thread.
  std::span<const Contact> contacts() const noexcept { return problem_.contacts(); }
  /// Where the ball rests on the surface, world frame [m]. For the tick's own thread.
  Vector3 proxy(std::size_t tool = 0) const noexcept { return tissue_->pose() * contact_tools_[tool].proxy; }
  /// Contact force before the gate, world frame [N]. For the tick's own thread.
  Vector3 contact_force(std::size_t tool = 0) const noexcept {
    return tissue_->pose().linear() * contact_tools_[tool].force;
  }

  /// Contact torque about the proxy before the gate, world frame [N m]. For the tick's own thread.
  Vector3 contact_torque(std::size_t tool = 0) const noexcept {
    return tissue_->pose().linear() * contact_tools_[tool].torque;
  }
  /// Axis of a capsule where it rests on the surface, world frame. For the tick's own thread.
  Vector3 proxy_axis(std::size_t tool = 0) const noexcept {
    return tissue_->pose().linear() * contact_tools_[tool].axis();
  }
  /// Whether a tool holds a point of the surface. For the tick's own thread.
  bool is_holding(std::size_t tool = 0) const noexcept { return problem_.is_holding(tool); }

  /// What limits a tool's energy. For the tick's own thread.
  const Energy& energy(std::size_t tool = 0) const noexcept { return energies_[tool]; }

  /// Newest snapshot, for one reader thread; never waits. Valid until the next call.
  const Snapshot& read_snapshot() noexcept {
    snapshots_.update();
    return snapshots_.front();
  }

 private:
  /// Notes when a tissue that moves by itself was last heard of.
  void note_updates() noexcept {
    if constexpr (requires { tissue_->updates(); }) {
      const std::uint64_t updates = tissue_->updates();
      const bool has_news = !started_ || updates != updates_;
      updates_ = updates;
      started_ = true;
      for (ToolInput& input : inputs_) input.note_tissue(has_news);
    }
  }

  static double smallest_radius(const std::vector<ContactTool>& tools) {
    return std::ranges::min_element(tools, {}, &ContactTool::radius)->radius;
  }
  static ToolState unreadable() noexcept {
    ToolState s;
    s.valid = false;
    return s;
  }

  void take(std::size_t i, const ToolState& state) noexcept {
    inputs_[i].take(state, tissue_->pose(), tissue_->contact_surface(), problem_.contacts(), contact_tools_[i]);
    energies_[i].turned(gates_[i].last_torque().dot(inputs_[i].rotation()));
  }

  /// A ball whose centre is in the body without any contact has lost the surface: it is put back in the next tick, with
  /// the ramp.
  void recover(std::size_t i) noexcept {
    const ContactTool& tool = contact_tools_[i];
    if (!tool.active || !tool.force.isZero(0.0)) return;
    // Far from all contact points nothing changes fast: one look in a while is enough, for one tool after the other.
    if (!problem_.is_near(static_cast<int>(i)) && (ticks_ + i) % 16 != 0) return;
    bool inside = false;
    for (const double s : {0.0, -tool.half_length, tool.half_length}) {
      inside = inside || tissue_->contact_surface().closest(tool.target + s * tool.axis()).distance < 0.0;
      if (tool.half_length == 0.0) break;
    }
    if (!inside) return;
    inputs_[i].lose();
  }

  /// The force of contact through energy tank, which is told of what is limited further, and gate.
  void pass(std::size_t i, Status shared) noexcept {
    const ContactTool& tool = contact_tools_[i];
    const ToolInput& input = inputs_[i];
    const auto& turn = tissue_->pose().linear();
    const Vector3 force = tool.active ? Vector3(turn * tool.force) : Vector3::Zero();
    const Vector3 torque = tool.active && input.turns() ? Vector3(turn * tool.torque) : Vector3::Zero();
    if (!input.readable() || input.restarted()) energies_[i].forget();
    Status energy;
    const Vector3 given = energies_[i].limit(force, tissue_->pose() * input.position(), input.time(), energy);
    double time = input.time();
    if constexpr (requires { tissue_->updates(); }) time = input.stamp(stale_tissue_after_);
    forces_[i] =
        gates_[i].apply(given, energies_[i].gain() * torque, input.time(), time, input.readable(), input.restarted());
    energies_[i].gave(forces_[i].force);
    forces_[i].status |= input.status() | shared | energy;
  }

  void publish() noexcept {
    Snapshot& s = snapshots_.back();
    s.note(problem_.contacts(), problem_.vertex_forces(), tissue_->pose());
    for (std::size_t i = 0; i < contact_tools_.size(); ++i) {
      s.proxies[i] = proxy(i);
      s.axes[i] = proxy_axis(i);
    }
    s.time = inputs_.front().time();
    snapshots_.publish();
  }

  Tissue* tissue_;
  std::vector<ContactTool> contact_tools_;
  ContactProblem<contact_capacity> problem_;
  std::vector<ToolInput> inputs_;
  std::vector<ForceGate> gates_;
  std::vector<Energy> energies_;
  std::vector<ToolForce> forces_;
  double stale_tissue_after_;
  std::uint64_t updates_ = 0;
  bool started_ = false;
  TripleBuffer<Snapshot> snapshots_;
  std::size_t ticks_ = 0;
};

}}  // namespace palpate
