// One haptic session: tools against a tissue, one force per tool and tick.
#pragma once

#include <palpate/concepts/servo.hpp>
#include <palpate/contact/capsule_tool.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/tool_placement.hpp>
#include <palpate/core/realtime.hpp>
#include <palpate/haptic/force_gate.hpp>
#include <palpate/haptic/passivity_observer.hpp>
#include <palpate/haptic/triple_buffer.hpp>

#include <optional>

namespace palpate::inline PALPATE_ABI {

/// What a session may choose.
struct ServoOptions {
  DeviceLimits device;                       ///< of the device that renders; gives the defaults below
  double rate = 1000.0;                      ///< [1/s] nominal rate of ticks
  std::optional<double> coupling_stiffness;  ///< [N/m] between proxy and device; default the device's stiffness,
                                             ///< infinity for verification
  std::optional<double> turning_stiffness;   ///< [N m/rad] the same for rotations; default the device's, or rigid for a
                                             ///< device that renders no torque
  std::optional<ForceLimits> force_limits;   ///< default ForceLimits::from(device, rate)
  ContactParameters contact;                 ///< friction too
  double stale_tissue_after = 0.5;           ///< [s] without news of a tissue that moves by itself until forces fade
  std::uint32_t grasp_buttons = 0;           ///< while one of these is pressed, the tool holds the point it touched
};

/// A contact that presses, world frame.
struct ToolContact {
  int tool = 0;
  Vector3 point = Vector3::Zero();     ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();    ///< unit, from the surface to the ball's centre
  double force = 0.0;                  ///< of the tissue on the ball along the normal, before the gate [N]
  Vector3 friction = Vector3::Zero();  ///< across it [N]
};

/// Contact state and force gate of one session. `tick` computes the force in the tick that brought the pose and passes
/// it through the gate: no way to the device goes round it. Refers to the tissue, which must outlive it; neither copied
/// nor moved. `Energy` limits what the tool may be given: NoEnergyTank, or an EnergyTank given as last argument.
template <TissueModel Tissue, class Energy = NoEnergyTank>
class HapticServo {
 public:
  static constexpr std::size_t max_tools = maximum_tools;
  /// Contacts of all tools; more are left out (degraded_model).
  static constexpr int contact_capacity = default_contact_capacity;

  /// What a renderer needs of a tick: forces on the contact surface, contacts and proxies of the tools in the world.
  struct Snapshot {
    std::array<VertexForce, 3 * contact_capacity> forces;
    std::size_t force_count = 0;
    std::array<ToolContact, contact_capacity> contacts;
    std::size_t contact_count = 0;
    std::array<Vector3, max_tools> proxies{};  ///< middle of every tool, world frame [m]
    std::array<Vector3, max_tools> axes{};     ///< of capsules, unit, world frame
    double time = 0.0;
    std::span<const VertexForce> vertex_forces() const noexcept { return {forces.data(), force_count}; }
    std::span<const ToolContact> tool_contacts() const noexcept { return {contacts.data(), contact_count}; }
  };

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
        problem_(tissue.contact_surface(), smallest_radius(tools), options.contact),
        contact_tools_(tools.size()),
        states_(tools.size()),
        energies_(tools.size(), energy),
        forces_(tools.size()),
        stale_tissue_after_(options.stale_tissue_after),
        grasp_buttons_(options.grasp_buttons) {
    if (tissue.contact_surface().triangles().empty())
      raise(SetupErrorKind::bad_argument, "nothing of this tissue can be touched",
            "Name a surface group with Scene::touch");
    if constexpr (requires { tissue.require_tools(0.0, options.contact); })
      tissue.require_tools(smallest_radius(tools), options.contact);
    const double stiffness = options.coupling_stiffness.value_or(options.device.stiffness);
    if (!(stiffness > 0.0))
      raise(SetupErrorKind::bad_argument, "the coupling stiffness is " + number(stiffness),
            "It must be positive, in N/m; infinity is allowed");
    if (!(options.stale_tissue_after > 0.0))
      raise(SetupErrorKind::bad_argument, "stale_tissue_after is " + number(options.stale_tissue_after),
            "It must be positive, in seconds; infinity is allowed");
    const ForceLimits limits = options.force_limits.value_or(ForceLimits::from(options.device, options.rate));
    const double turning = turning_stiffness(options, limits);
    for (std::size_t i = 0; i < tools.size(); ++i) {
      contact_tools_[i].radius = tools[i].radius;
      contact_tools_[i].compliance = 1.0 / stiffness;
      contact_tools_[i].half_length = tools[i].half_length;
      if (tools[i].half_length > 0.0) contact_tools_[i].own_axis = tools[i].axis.normalized();
      contact_tools_[i].turning_compliance = 1.0 / turning;
      gates_.emplace_back(limits);
      states_[i].turns = tools[i].half_length > 0.0 || limits.peak_torque > 0.0;
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
    note_updates();
    shared |= problem_.solve(*tissue_, contact_tools_);
    for (std::size_t i = 0; i < states_.size(); ++i) recover(i);
    for (std::size_t i = 0; i < states_.size(); ++i) {
      const ContactTool& tool = contact_tools_[i];
      const auto& turn = tissue_->pose().linear();
      const Vector3 wanted = tool.active ? Vector3(turn * tool.force) : Vector3::Zero();
      const Vector3 torque = tool.active && states_[i].turns ? Vector3(turn * tool.torque) : Vector3::Zero();
      const Input& input = states_[i];
      Status energy;
      const Vector3 given = limit_energy(i, wanted, energy);
      forces_[i] = gates_[i].apply(given, energies_[i].gain() * torque, input.time, stamp(input), input.readable,
                                   input.restarted);
      energies_[i].gave(forces_[i].force);
      forces_[i].status |= input.status | shared | energy;
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
    started_ = false;
    for (Input& input : states_) {
      const bool turns = input.turns;
      input = Input{};
      input.turns = turns;
    }
    for (ContactTool& tool : contact_tools_) {
      tool.active = tool.grasping = false;
      tool.force.setZero();
      tool.torque.setZero();
    }
    for (ForceGate& gate : gates_) gate.reset();
    if constexpr (requires { tissue_->end_tick(problem_.vertex_forces()); })
      tissue_->end_tick(std::span<const VertexForce>());
    for (Energy& energy : energies_) energy.reset();
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
  struct Input {
    Vector3 position = Vector3::Zero();  // last good one, model frame
    double time = 0.0;
    double news = 0.0;   // when the tissue had moved last
    bool known = false;  // position is valid
    bool readable = false;
    bool restarted = false;
    bool turns = false;  // orientation and torque matter
    Status status;
  };

  /// Notes when a tissue that moves by itself was last heard of.
  void note_updates() noexcept {
    if constexpr (requires { tissue_->updates(); }) {
      const std::uint64_t updates = tissue_->updates();
      const bool has_news = !started_ || updates != updates_;
      updates_ = updates;
      started_ = true;
      for (Input& input : states_)
        if (has_news || !(input.news <= input.time)) input.news = input.time;
    }
  }
  /// What the gate takes for the time of the input: it stands still while the tissue is not heard of.
  double stamp(const Input& input) const noexcept {
    if constexpr (requires { tissue_->updates(); }) return std::min(input.time, input.news + stale_tissue_after_);
    return input.time;
  }

  static double turning_stiffness(const ServoOptions& options, const ForceLimits& limits) {
    const double given = options.turning_stiffness.value_or(
        options.device.turning_stiffness > 0.0 || limits.peak_torque > 0.0 ? options.device.turning_stiffness
                                                                           : infinity);
    if (!(given > 0.0))
      raise(SetupErrorKind::bad_argument, "the turning stiffness is " + number(given),
            "A device that renders torque needs one, in N m/rad; infinity is allowed");
    return given;
  }
  static double smallest_radius(const std::vector<CapsuleTool>& tools) {
    if (tools.empty() || tools.size() > max_tools)
      raise(SetupErrorKind::bad_argument,
            "a servo has one to " + std::to_string(max_tools) + " tools, not " + std::to_string(tools.size()));
    for (const CapsuleTool& tool : tools) tool.require_valid();
    return std::ranges::min_element(tools, {}, &CapsuleTool::radius)->radius;
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
    tool.turned = 0.0;
    if (!state.valid) {
      tool.active = tool.grasping = input.known = false;
      tool.force.setZero();
      tool.torque.setZero();
      return;
    }
    const Vector3 position = tissue_->pose().inverse() * state.position;
    // Beyond this no workspace reaches, and squares keep clear of overflow.
    Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
    if (input.turns) {
      const auto& q = state.orientation;
      turn = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
    }
    const double length = turn.norm();
    const bool finite = position.allFinite() && position.cwiseAbs().maxCoeff() < 1e6 && std::isfinite(state.time) &&
                        length > 0.5 && length < 2.0;
    if (!finite) {
      // The last good pose is held; its old time stamp makes the gate fade the force.
      input.status.set(StatusFlag::non_finite_input);
      input.readable = input.known;
      return;
    }
    input.time = state.time;
    tool.grasping = (state.buttons & grasp_buttons_) != 0;
    const Vector3 motion = position - input.position;
    if (input.turns) rotate(i, turn.normalized());
    input.restarted = !input.known;
    if (!input.known) {
      place_beside(tool, tissue_->contact_surface(), position);
    } else if (motion.norm() + tool.turned > 2.0 * tool.radius) {
      jump(i, position);
    } else {
      tool.motion = motion;
    }
    input.position = tool.target = position;
    input.known = tool.active = true;
  }

  /// Takes in where the device has turned to, and what the torque did on the way.
  void rotate(std::size_t i, const Eigen::Quaterniond& turn) noexcept {
    ContactTool& tool = contact_tools_[i];
    const Matrix3 rotation = tissue_->pose().linear().transpose() * turn.toRotationMatrix();
    if (states_[i].known) {
      const Eigen::AngleAxisd by(Matrix3(rotation * tool.target_rotation.transpose()));
      const Vector3 way = by.angle() * (tissue_->pose().linear() * by.axis());
      energies_[i].turned(gates_[i].last_torque().dot(way));
      tool.turned = tool.half_length * ((rotation - tool.target_rotation) * tool.own_axis).norm();
    }
    tool.target_rotation = rotation;
  }

  /// A tool that moved farther than its diameter in a tick starts anew where its way first met the surface, else where
  /// it is: however fast it is, it gets through nothing.
  void jump(std::size_t i, const Vector3& position) noexcept {
    ContactTool& tool = contact_tools_[i];
    sweep(tool, tissue_->contact_surface(), off_surface(i), position);
    tool.turned = 0.0;
    tool.grasping = false;
    states_[i].restarted = true;
    states_[i].status.set(StatusFlag::reacquired);
  }

  /// The proxy, lifted as far as the surface that it presses in will spring back.
  Vector3 off_surface(std::size_t i) const noexcept {
    const ContactTool& tool = contact_tools_[i];
    const double force = tool.force.norm();
    if (!(force > 0.0)) return tool.proxy;
    double dent = 0.0;
    for (const Contact& c : problem_.contacts())
      if (c.tool == static_cast<int>(i) && c.force > 0.0)
        dent = std::max(dent, (c.rest - c.point).dot(tool.force) / force);
    return tool.proxy + (dent / force) * tool.force;
  }

  /// A ball whose centre is in the body without any contact has lost the surface: it is put back in the next tick, with
  /// the ramp.
  void recover(std::size_t i) noexcept {
    const ContactTool& tool = contact_tools_[i];
    if (!tool.active || !tool.force.isZero(0.0)) return;
    // Far from all contact points nothing changes fast: one look in a while is enough.
    if (!problem_.is_near(static_cast<int>(i)) && ++ticks_ % 16 != 0) return;
    bool inside = false;
    for (const double s : {0.0, -tool.half_length, tool.half_length}) {
      inside = inside || tissue_->contact_surface().closest(tool.target + s * tool.axis()).distance < 0.0;
      if (tool.half_length == 0.0) break;
    }
    if (!inside) return;
    states_[i].known = false;
    states_[i].status.set(StatusFlag::reacquired);
  }

  /// Before the gate: what it limits further has then been given.
  Vector3 limit_energy(std::size_t i, const Vector3& wanted, Status& status) noexcept {
    const Input& input = states_[i];
    if (!input.readable || input.restarted) energies_[i].forget();
    return energies_[i].limit(wanted, tissue_->pose() * input.position, input.time, status);
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
                                         c.force, tissue_->pose().linear() * c.friction};
    for (std::size_t i = 0; i < contact_tools_.size(); ++i) {
      s.proxies[i] = proxy(i);
      s.axes[i] = proxy_axis(i);
    }
    s.time = states_.front().time;
    snapshots_.publish();
  }

  Tissue* tissue_;
  ContactProblem<contact_capacity> problem_;
  std::vector<ContactTool> contact_tools_;
  std::vector<Input> states_;
  std::vector<ForceGate> gates_;
  std::vector<Energy> energies_;
  std::vector<ToolForce> forces_;
  double stale_tissue_after_;
  std::uint32_t grasp_buttons_;
  std::uint64_t updates_ = 0;
  bool started_ = false;
  TripleBuffer<Snapshot> snapshots_;
  unsigned ticks_ = 0;
};

}  // namespace palpate::inline PALPATE_ABI
