#include "run.hpp"

#include "reference.hpp"

#include <palpate/core/setup_error.hpp>
#include <palpate/device/recorder.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

namespace cross {

namespace {

using namespace palpate;

Eigen::Isometry3d pose_of(const std::string& word) {
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  if (word == "rotated")
    pose = Eigen::Translation3d(0.3, -0.2, 0.1) * Eigen::AngleAxisd(2.0, Vector3(1.0, 2.0, 3.0).normalized());
  return pose;
}

ServoOptions options_of(const Scene& scene, const Manner& manner) {
  ServoOptions options;
  options.rate = scene.rate;
  options.coupling_stiffness = scene.coupling * manner.change.scale;
  options.contact.friction = manner.frictionless ? 0.0 : scene.friction;
  options.contact.capacity = manner.capacity >= 0 ? manner.capacity : scene.capacity;
  options.corrected_force = scene.corrected;
  if (std::any_of(scene.tools.begin(), scene.tools.end(), [](const ToolValue& t) { return t.grasps; }))
    options.grasp_buttons = 1;
  return options;
}

/// A plane through the body across its x axis, which a cut follows for a part of its height.
BladeSweep sweep_of(const Scene& scene, int number, const Eigen::Isometry3d& pose, const Change& change) {
  const Place place = place_of(scene, 0.317 + 0.153 * number, 0.523, false);
  const Vector3 across = place.normal.cross(place.along), out = place.normal;
  const double half = 3.0 * scene.edge, deep = 0.8 * scene.edge;
  const auto at = [&](double a, double n) { return pose * change(place.point + a * across + n * out); };
  return {at(-half, -deep), at(half, -deep), at(-half, scene.edge), at(half, scene.edge)};
}

/// The device of a recording.
struct Script {
  ToolState state{};
  ToolState read() noexcept { return state; }
  Status write(const GatedForce&) noexcept { return {}; }
  DeviceLimits limits() const noexcept { return {}; }
  void start() {}
  void stop() noexcept {}
};

/// One run of a scene.
class Player {
 public:
  Player(const Scene& scene, const Manner& manner)
      : scene_(scene), manner_(manner), pose_(pose_of(manner.pose.empty() ? scene.pose : manner.pose)) {
    const std::string solver = manner.solver.empty() ? scene.solver : manner.solver;
    TissueOptions options;
    options.threads = manner.threads > 0 ? manner.threads : scene.threads;
    options.cache_file = manner.cache_file;
    options.member = manner.member.empty() ? scene.member : manner.member;
    options.axes = manner.change.linear;
    Scene at_start = scene;
    if (manner.loaded_later) at_start.load = "none";
    const Body body = manner.reference ? reference_body(scene) : make_body(at_start, manner.change);
    const Composition* composition = manner.reference ? find_composition("tet10", "linear", "condensed")
                                                      : find_composition(scene.element, scene.law, solver);
    if (composition == nullptr)
      throw std::runtime_error("no composition " + scene.element + ", " + scene.law + ", " + solver);
    Scene built = scene;
    built.solver = composition->solver;
    built.element = composition->element;
    conditions_at_ = body.conditions_at;
    if (manner.loaded_later)
      conditions_at_ = [&scene, change = manner.change](double part) {
        Scene loaded = scene;
        loaded.load_size *= part;
        return make_body(loaded, change).conditions;
      };
    tissue_ = composition->make(built, body, options);
    tissue_->set_pose(pose_);
    tools_ = tools_of(scene, manner.change, pose_);
    servo_options_ = options_of(scene, manner);
  }

  Run play() {
    servo_ = tissue_->servo(tools_, servo_options_);
    if (manner_.second_servo) second_ = tissue_->servo(tools_, servo_options_);
    for (int play = 0; play < manner_.plays; ++play) {
      if (play > 0) restart();
      run_ = {};
      if (manner_.recorded) start_recording(play);
      one_play();
      if (manner_.recorded) end_recording(play);
    }
    run_.misrecorded = misrecorded_;
    const SetupReport& report = tissue_->report();
    run_.has_report =
        report.kept_dofs == 0 || report.stiffness_bytes + report.solver_bytes + report.compliance_bytes > 0;
    run_.notes = servo_->notes();
    return std::move(run_);
  }

 private:
  void start_recording(int play) {
    if (play == 0) {
      recorder_.emplace(script_, static_cast<std::size_t>(ticks_of(scene_, manner_.change)));
      recorder_->start();
    } else {
      replay_.emplace(manner_.cache_file);
    }
  }
  void end_recording(int play) {
    if (play > 0) return;
    recorder_->write(GatedForce());  // as a loop ends
    recorder_->stop();
    recorder_->write_csv(manner_.cache_file);
    const auto recorded = read_recording(manner_.cache_file);
    for (std::size_t k = 0; k < recorded.size() && misrecorded_ < 0; ++k)
      if (recorded[k].force != rendered_.at(k)) misrecorded_ = static_cast<int>(k);
    recorder_.reset();
  }
  void restart() {
    worker_.reset();
    servo_->reset();
    tissue_->reset();
    tissue_->set_pose(pose_);
    if (!manner_.new_servo) return;
    servo_.reset();
    servo_ = tissue_->servo(tools_, servo_options_);
  }

  void one_play() {
    if (manner_.worker) worker_ = tissue_->worker();
    const int ticks = ticks_of(scene_, manner_.change);
    double due = 0.0;  // of the next piece of background work
    std::vector<Vector3> start;
    auto wake = std::chrono::steady_clock::now();
    for (int tick = 0; tick < ticks; ++tick) {
      const double now = static_cast<double>(tick) / scene_.rate;
      for (int i = 0; i < scene_.cuts; ++i)
        if (tick == (i + 1) * ticks / (scene_.cuts + 2)) tissue_->cut(sweep_of(scene_, i, pose_, manner_.change));
      if (!worker_ && tissue_->interval() > 0.0)
        for (; due <= now; due += tissue_->interval()) {
          if (conditions_at_) tissue_->set_conditions(conditions_at_(part_at(tick)));
          tissue_->work();
        }
      one_tick(tick);
      if (tick == 0) start = rest();  // the tick has taken the surface of the first step, which has the pose
      wake += std::chrono::microseconds(1000000 / scene_.rate);
      if (worker_) std::this_thread::sleep_until(wake);
    }
    const bool steps = !worker_ && tissue_->interval() > 0.0;
    worker_.reset();
    if (!steps || start.empty()) return;
    for (int step = 0; step < 5; ++step) tissue_->work();
    const std::vector<Vector3> end = rest();
    for (std::size_t i = 0; i < std::min(start.size(), end.size()); ++i)
      run_.left = std::max(run_.left, (start[i] - end[i]).norm() / manner_.change.scale);
  }
  double part_at(int tick) const {
    if (!manner_.loaded_later) return support_part(scene_, tick);
    return std::min(1.0, 2.0 * tick / scene_.ticks);
  }
  /// The surface of moving tissue without contact.
  std::vector<Vector3> rest() {
    return moves(scene_.solver) && !is_cut(scene_) ? tissue_->surface({}) : std::vector<Vector3>();
  }

  Vector3 back(const Vector3& force) const {
    return manner_.change.linear.transpose() * (pose_.linear().transpose() * force);
  }

  void one_tick(int tick) {
    const std::size_t count = scene_.tools.size();
    std::vector<ToolState> states;
    for (std::size_t t = 0; t < count; ++t) states.push_back(state_of(scene_, t, tick, pose_, manner_.change));
    if (recorder_) script_.state = states[0], states[0] = recorder_->read();
    if (replay_) states[0] = replay_->read();
    const auto forces = servo_->tick(states);
    if (recorder_) recorder_->write(forces[0]), rendered_.push_back(forces[0].force());
    if (second_) second_tick(states);
    const double s = manner_.change.scale;
    std::vector<ToolTick> record(count);
    Vector3 sum = Vector3::Zero();
    for (std::size_t t = 0; t < count; ++t) {
      ToolTick& r = record[t];
      const Vector3 force = servo_->tick_view().contact_force(t), torque = servo_->tick_view().contact_torque(t);
      const auto original = [&](const Vector3& x) {
        return Vector3(manner_.change.linear.transpose() * (pose_.inverse() * x - manner_.change.shift) / s);
      };
      r.position = original(states[t].position);
      r.proxy = original(servo_->tick_view().proxy(t));
      r.force = back(force) / (s * s);
      // A torque is a pseudovector: a reflection reverses it.
      r.torque = manner_.change.linear.determinant() * back(torque) / (s * s * s);
      r.rendered = back(forces[t].force()) / (s * s);
      r.status = forces[t].status;
      r.bound = servo_->tick_view().force_error(t).bound / (s * s);
      r.of_points = servo_->tick_view().force_error(t).parts.merged / (s * s);
      r.depth = depth_of(scene_, t, tick);
      r.finite =
          force.allFinite() && torque.allFinite() && forces[t].force().allFinite() && forces[t].torque().allFinite();
      if (scene_.tools[t].kind != "blade") sum += force;
      run_.peak = std::max(run_.peak, r.force.norm());
    }
    const ServoSnapshot& snapshot = servo_->read_snapshot();
    for (const VertexForce& f : snapshot.vertex_forces()) sum += pose_.linear() * f.force.in_model_axes();
    run_.imbalance.push_back(sum.norm() / (s * s));
    if (tick == last_hold(scene_) - 1) run_.penetration = penetration(snapshot) / s;
    add_work(record);
    run_.ticks.push_back(std::move(record));
  }

  /// Of a servo whose tools are far away.
  void second_tick(std::vector<ToolState> states) {
    for (std::size_t t = 0; t < states.size(); ++t) {
      const Place place = place_of(scene_, scene_.tools[t].u, scene_.tools[t].v, scene_.tools[t].opposite);
      states[t].position += 20.0 * manner_.change.scale * scene_.tools[t].radius *
                            (pose_.linear() * manner_.change.direction(place.normal));
    }
    (void)second_->tick(states);
  }

  /// Work by the mean of the forces before and after a motion.
  void add_work(const std::vector<ToolTick>& record) {
    if (run_.ticks.empty()) return;
    for (std::size_t t = 0; t < record.size(); ++t) {
      const ToolTick& before = run_.ticks.back()[t];
      run_.work -= 0.5 * (before.force + record[t].force).dot(record[t].position - before.position);
    }
    run_.work_in = std::max(run_.work_in, run_.work);
  }

  /// Of vertices with facets that are no longer than the radius: the dents of others are between the vertices.
  double penetration(const ServoSnapshot& snapshot) {
    double deepest = 0.0;
    const std::vector<Vector3> surface = tissue_->surface(snapshot.vertex_forces());
    const std::vector<double> facets = tissue_->facet_lengths();
    for (std::size_t t = 0; t < scene_.tools.size(); ++t) {
      if (scene_.tools[t].kind != "sphere") continue;
      const double radius = manner_.change.scale * scene_.tools[t].radius;
      for (std::size_t v = 0; v < surface.size(); ++v)
        if (facets[v] <= radius)
          deepest = std::max(deepest, radius - (surface[v] - servo_->tick_view().proxy(t)).norm());
    }
    return deepest;
  }

  const Scene& scene_;
  Manner manner_;
  Eigen::Isometry3d pose_;
  ToolList tools_{SphereTool{}};
  ServoOptions servo_options_;
  std::unique_ptr<Tissue> tissue_;
  std::unique_ptr<HapticServo> servo_, second_;
  std::function<palpate::Scene(double)> conditions_at_;
  Script script_;
  std::optional<Recorder<Script>> recorder_;
  std::optional<ReplayDevice> replay_;
  std::vector<Vector3> rendered_;  // of the play that is recorded
  int misrecorded_ = -1;
  std::unique_ptr<BackgroundWorker> worker_;
  Run run_;
};

}  // namespace

Run run(const Scene& scene, const Manner& manner) {
  try {
    return Player(scene, manner).play();
  } catch (const SetupError& error) {
    Run refused;
    refused.refused = std::string(to_string(error.kind()));
    refused.message = error.what();
    return refused;
  }
}

}  // namespace cross
