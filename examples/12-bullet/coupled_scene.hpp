// Instruments of Bullet on tissue of palpate: one implicit step for both, and its energy.
#pragma once

#include "instruments.hpp"
#include "metered_motion.hpp"

namespace bullet_example {

using namespace palpate;

using Elastic = Corotational;
using Tissue = HapticFEModel<Tet4, Elastic, Metered<Implicit<MatrixFreeCG<BlockJacobi, float>>>>;

/// Energies [J]. Stored ones are those of the moment, the others are sums since the start.
struct Energy {
  double kinetic = 0.0, weight = 0.0;                ///< of the instruments
  double springs = 0.0;                              ///< between hands and instruments
  double tissue_kinetic = 0.0, tissue_stored = 0.0;  ///< of the tissue
  double work_of_hands = 0.0;
  double lost_in_hands = 0.0;        ///< dampers beside the springs
  double lost_by_instruments = 0.0;  ///< their collisions, and the time integration
  double lost_at_surface = 0.0;      ///< impact, friction, and the remaining error of the contact
  double lost_in_tissue = 0.0;       ///< viscosity, and the time integration

  double total() const { return kinetic + weight + springs + tissue_kinetic + tissue_stored; }
  double lost() const { return lost_in_hands + lost_by_instruments + lost_at_surface + lost_in_tissue; }
};

/// Advances rigid instruments and tissue by steps of one millisecond. A step of the tissue and of the instruments on it
/// is one step of implicit Euler, without a delay between them:
///
///   position x' of an instrument: m (x' - x_free) / dt^2 = F(x'), where x_free is the position without tissue.
///
/// That is the contact problem of a tick, with x_free as the position of the device and m / dt^2 as the stiffness of
/// the coupling. The proxy is then the position that the instrument is going to have.
class CoupledScene {
 public:
  static constexpr double dt = 1e-3;  // [s]

  CoupledScene(Tissue& tissue, std::vector<Instrument> instruments, double friction)
      : tissue_(tissue),
        instruments_(std::move(instruments)),
        rigid_(instruments_, {0.0, 0.0, -9.81}),
        servo_(tissue, tools(), options(friction)),
        states_(instruments_.size()),
        hands_(instruments_.size()) {
    for (std::size_t i = 0; i < size(); ++i) hands_[i].position = hands_[i].next = rigid_.position(i);
    weight_at_start_ = rigid_.weight_energy();
    tissue_.advance();
  }

  std::size_t size() const { return instruments_.size(); }
  const Instrument& instrument(std::size_t i) const { return instruments_[i]; }
  const RigidWorld& rigid() const { return rigid_; }
  RigidWorld& rigid() { return rigid_; }
  const HapticServo& servo() const { return servo_; }
  const StatusCounters& status() const { return status_; }
  double time() const { return time_; }
  bool finite() const { return finite_; }  ///< all forces so far

  /// Where a hand holds its instrument at the end of the next step.
  void move_hand(std::size_t i, const Vector3& to) { hands_[i].next = to; }
  /// A hand takes a free instrument away at once, and lets it fall from `from`.
  void drop(std::size_t i, const Vector3& from) {
    const double before = rigid_.kinetic_energy() + rigid_.weight_energy();
    rigid_.drop(i, from);
    sums_.work_of_hands += rigid_.kinetic_energy() + rigid_.weight_energy() - before;
    states_[i].valid = false;  // for one tick: nothing presses it
  }

  void step() {
    for (std::size_t i = 0; i < size(); ++i) hands_[i].start = rigid_.position(i);
    rigid_.step(dt);
    time_ += dt;
    for (std::size_t i = 0; i < size(); ++i) aim(i);
    for (const GatedForce& force : servo_.tick(states_)) status_.count(force.status);
    for (std::size_t i = 0; i < size(); ++i) push(i);
    tissue_.advance();  // corrects the tissue for these forces, then predicts its next step
  }

  Energy energy() const {
    Energy e = sums_;
    e.kinetic = rigid_.kinetic_energy();
    e.weight = rigid_.weight_energy() - weight_at_start_;
    for (std::size_t i = 0; i < size(); ++i)
      e.springs += 0.5 * instruments_[i].hand_stiffness * (hands_[i].position - rigid_.position(i)).squaredNorm();
    const MeteredMotion& meter = dynamic_cast<const MeteredMotion&>(tissue_.motion());
    e.tissue_kinetic = meter.kinetic_energy();
    e.tissue_stored = meter.stored_energy();
    e.lost_by_instruments =
        work_on_instruments_ + sums_.work_of_hands - sums_.lost_in_hands - e.kinetic - e.weight - e.springs;
    e.lost_at_surface = -work_on_instruments_ - meter.work();
    e.lost_in_tissue = meter.work() - e.tissue_kinetic - e.tissue_stored;
    return e;
  }

 private:
  struct Hand {
    Vector3 position = Vector3::Zero(), next = Vector3::Zero();  ///< before and after the step
    Vector3 start = Vector3::Zero();                             ///< of the instrument, before the step
  };

  ToolList tools() const {
    std::vector<Tool> all;
    for (const Instrument& i : instruments_)
      if (i.half_length > 0.0)
        all.emplace_back(CapsuleTool(i.radius, i.half_length));
      else
        all.emplace_back(SphereTool{i.radius});
    return all;
  }
  /// Inertia and hand, as a stiffness at the end of a step [N/m].
  double stiffness(std::size_t i) const {
    const Instrument& b = instruments_[i];
    return b.mass / (dt * dt) + b.hand_stiffness + b.hand_damping / dt;
  }
  ServoOptions options(double friction) const {
    ServoOptions made;
    for (std::size_t i = 0; i < size(); ++i) {
      DeviceLimits device;
      device.stiffness = stiffness(i);
      device.rotational_stiffness = rigid_.inertia(i) / (dt * dt);
      device.peak_torque = 1.0;  // [N m] positive: it rotates, spheres too
      made.devices.push_back(device);
    }
    made.contact.friction = friction;
    made.contact.force_tolerance = 1e-4;
    made.contact.maximum_iterations = 8;
    return made;
  }

  /// The pose after the step with the hand, but without tissue.
  void aim(std::size_t i) {
    const Instrument& b = instruments_[i];
    const Hand& hand = hands_[i];
    ToolState& state = states_[i];
    state.position = (b.mass / (dt * dt) * rigid_.position(i) + b.hand_stiffness * hand.next +
                      b.hand_damping / dt * (hand.start + hand.next - hand.position)) /
                     stiffness(i);
    state.orientation = to_array(rigid_.pose(i).getRotation());
    state.time = state.now = time_;
  }
  /// Applies the force of the tissue, before the force gate, which protects motors and hands, and that of the hand.
  void push(std::size_t i) {
    const Instrument& b = instruments_[i];
    Hand& hand = hands_[i];
    const Vector3 force = servo_.tick_view().contact_force(i), torque = servo_.tick_view().contact_torque(i);
    finite_ = finite_ && force.allFinite() && torque.allFinite();
    const Vector3 path = hand.next - hand.position;
    const Vector3 end = states_[i].position + force / stiffness(i), moved = end - hand.start;
    const Vector3 damping = b.hand_damping / dt * (path - moved);
    const Vector3 hand_force = b.hand_stiffness * (hand.next - end) + damping;  // zero for a free instrument
    rigid_.push(i, force + hand_force, torque, dt);
    work_on_instruments_ += force.dot(moved) + dt * torque.dot(rigid_.angular_velocity(i));
    sums_.work_of_hands += hand_force.dot(path);
    sums_.lost_in_hands += damping.dot(path - moved);
    hand.position = hand.next;
    states_[i].valid = true;
  }

  Tissue& tissue_;
  std::vector<Instrument> instruments_;
  RigidWorld rigid_;
  HapticServo servo_;
  std::vector<ToolState> states_;
  std::vector<Hand> hands_;
  StatusCounters status_;
  Energy sums_;  // only the sums over steps
  double work_on_instruments_ = 0.0, weight_at_start_ = 0.0, time_ = 0.0;
  bool finite_ = true;
};

}  // namespace bullet_example
