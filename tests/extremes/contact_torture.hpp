// Random contact sessions: tools of all sizes against bodies of all facet sizes, and counts of what must never happen.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace test {

using namespace palpate;

/// Events over all sessions. Those from `lost` on must be zero.
struct TortureCounts {
  long sessions = 0, ticks = 0;
  long pressed = 0;  ///< ticks of tools with a force
  long steady = 0;   ///< presses that stay at the same place at the end, and are checked
  long reacquired = 0, not_converged = 0, degraded = 0;  ///< ticks of tools with these flags
  long everted = 0;        ///< proxies at a surface whose elements are inverted: it has no inside
  long caught_up = 0;      ///< those of the jumps whose tick before was flagged
  long lost = 0;           ///< without force or flag, with the target inside the body
  long unsettled = 0;      ///< steady presses whose force still changes by more than 2 %, or restarts
  long inside = 0;         ///< tools whose proxy is inside the deformed body at the end
  long jumps = 0;          ///< ticks in which a force changes by more than motion and coupling allow
  long non_finite = 0;     ///< forces that are not finite, or longer than the device's limit
  long energy_gained = 0;  ///< masses thrown at a body that have more energy afterwards
};

/// One random session of 1 ms ticks. Everything follows from the seed.
class TortureSession {
 public:
  using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
  static constexpr int hold_ticks = 400, watched_ticks = 100;

  TortureSession(std::uint64_t seed, bool print) : random_(seed), seed_(seed), print_(print) {
    make_body();
    make_tools();
  }

  void run(int ticks, TortureCounts& counts) {
    ++counts.sessions;
    std::vector<double> low(tools_.size(), infinity), high(tools_.size(), 0.0);
    std::vector<bool> restarted(tools_.size(), false);
    for (int k = 0; k < ticks; ++k) {
      const int left = ticks - k;
      for (Tool& tool : tools_) move(tool, k, left <= hold_ticks);
      tick(counts);
      for (std::size_t t = 0; t < tools_.size() && left <= watched_ticks; ++t) {
        const double force = tools_[t].force.norm();
        low[t] = std::min(low[t], force);
        high[t] = std::max(high[t], force);
        restarted[t] = restarted[t] || tools_[t].status.has(StatusFlag::reacquired);
      }
    }
    const bool tangled = std::any_of(tools_.begin(), tools_.end(), [](const Tool& t) { return t.tangled; });
    for (std::size_t t = 0; t < tools_.size() && !tangled; ++t) {
      if (!(high[t] > 0.0) || !(height(tools_[t].state.position) < tools_[t].radius)) continue;
      ++counts.steady;
      if (restarted[t] || high[t] - low[t] > 0.02 * high[t] + 2e-3) note(counts.unsettled, "unsettled", t);
    }
    if (!tangled) check_sides(counts);
  }

  /// Throws the first tool, as a mass in a hand with some damping, at the body: kinetic and dissipated energy together
  /// never exceed what it started with. A force that is constant for a tick of T gives no more than a damping of -K T/2
  /// would (Colgate and Schenkel 1997).
  void throw_mass(int ticks, TortureCounts& counts) {
    ++counts.sessions;
    Tool& tool = tools_[0];
    if (height(tool.to) < tool.radius) return;  // it would begin inside
    const double mass = random_.uniform(0.05, 0.2), damping = random_.uniform(1.0, 3.0);
    const Vector3 goal = near_surface(tool, 0.0);
    Vector3 position = tool.to, velocity = random_.uniform(0.1, 1.0) * (goal - tool.to).normalized();
    const double start = 0.5 * mass * velocity.squaredNorm();
    double dissipated = 0.0, most = 0.0;
    for (int k = 0; k < ticks; ++k) {
      for (Tool& other : tools_) other.state.time = 1e-3 * k, other.state.position = other.to;
      tool.state.position = position;
      std::vector<ToolState> states;
      for (const Tool& t : tools_) states.push_back(t.state);
      servo_->tick(states);
      const Vector3 force = servo_->tick_view().contact_force();
      ++counts.ticks;
      counts.pressed += force.norm() > 0.0;
      // The hand moves under the force of this tick until the next: exact for a constant force and no damping.
      const Vector3 drag = damping * velocity, before = velocity;
      velocity += 1e-3 / mass * (force - drag);
      const Vector3 mean = 0.5 * (before + velocity);
      position += 1e-3 * mean;
      dissipated += 1e-3 * (drag.dot(mean) - 0.5e-3 * stiffness_ * mean.squaredNorm());
      most = std::max(most, 0.5 * mass * velocity.squaredNorm() + dissipated);
    }
    if (!(most <= 1.002 * start + 1e-9)) note(counts.energy_gained, "energy gained", 0);
  }

 private:
  struct Tool {
    double radius = 0.0;
    int triangle = 0;      // below the present target
    bool crosses = false;  // the present path may lead through the body
    bool tangled = false;  // so did a path since the tool was last free, or the force was beyond the device's limit:
                           // it would have been pushed away
    double pace = 0.0;     // mean motion over about 30 ticks [m]
    ToolState state{};
    Vector3 from = Vector3::Zero(), to = Vector3::Zero();  // of the present motion, model frame
    int length = 1, done = 0, pause = 0, unreadable = 0;   // [ticks]
    int readable = 0;                                      // ticks since the last lost reading or restart
    Vector3 force = Vector3::Zero(), last_position = Vector3::Zero();
    Status status{};
    bool flagged = false;  // as not converged, in the last tick
  };

  double logarithmic(double low, double high) { return low * std::pow(high / low, random_.uniform()); }
  bool chance(double p) { return random_.uniform() < p; }

  void make_body() {
    edge_ = logarithmic(1e-3, 30e-3);
    const int kind = static_cast<int>(random_.uniform(0.0, 3.0));
    std::array<int, 3> cells{};
    if (kind == 0)  // block
      for (int& n : cells) n = 2 + static_cast<int>(random_.uniform(0.0, 6.0));
    else if (kind == 1)  // plate
      cells = {4 + static_cast<int>(random_.uniform(0.0, 8.0)), 4 + static_cast<int>(random_.uniform(0.0, 8.0)), 1};
    else  // beam
      cells = {6 + static_cast<int>(random_.uniform(0.0, 10.0)), 2, 2};
    Vector3 size;
    for (int c = 0; c < 3; ++c) size[c] = edge_ * cells[static_cast<std::size_t>(c)];
    if (kind == 1) size[2] *= random_.uniform(0.2, 1.0);
    thickness_ = size.minCoeff();
    auto mesh = box_tet4(size, cells, BoxSplit::six);
    const bool bumpy = chance(0.5);  // a curved, irregular surface
    for (Vector3& x : mesh.positions)
      if (bumpy)
        x += std::min(0.15 * thickness_, 0.1 * edge_) *
             Vector3(std::sin(40.0 * x[1]), std::sin(55.0 * x[0]), std::sin(70.0 * x[0] + 30.0 * x[1]));
    Scene scene;
    kind == 0 ? scene.fix("z0") : scene.fix("x0");
    if (kind == 1) scene.fix("x1");
    is_open_ = chance(0.4);
    is_open_ ? scene.touch("z1") : scene.touch("surface");
    const LinearElastic material{.youngs_modulus = logarithmic(2e3, 2e5), .poisson_ratio = random_.uniform(0.1, 0.47)};
    model_ =
        std::make_unique<Model>(std::move(mesh), scene, material, SetupOptions{.columns = ColumnFill::synchronous});
    name_ = std::string(kind == 0   ? "block"
                        : kind == 1 ? "plate"
                                    : "beam") +
            (is_open_ ? ", open" : "") + (bumpy ? ", bumpy" : "");
  }

  void make_tools() {
    const ContactSurface& surface = model_->contact_surface();
    double longest = 0.0;
    for (const Triangle& t : surface.triangles())
      for (std::size_t i = 0; i < 3; ++i)
        longest = std::max(longest, (surface.position(t[i]) - surface.position(t[(i + 1) % 3])).norm());
    const int count = chance(0.5) ? 1 : 1 + static_cast<int>(random_.uniform(0.0, 8.0));
    std::vector<SphereTool> shapes;
    for (int i = 0; i < count; ++i) {
      Tool tool;
      tool.radius = std::max(logarithmic(1e-4, 20e-3), longest / 31.0);
      shapes.push_back({.radius = tool.radius});
      tool.to = near_surface(tool, -2.0);
      tools_.push_back(tool);
    }
    ServoOptions options;
    if (chance(0.3)) options.contact.friction = random_.uniform(0.1, 1.0);
    friction_ = options.contact.friction;
    stiffness_ = options.device_of(0).stiffness;
    peak_force_ = options.device_of(0).peak_force;
    servo_ = std::make_unique<HapticServo>(*model_, ToolList(shapes), options);
  }

  /// A position over a random triangle, mostly of similar direction as the last, `depth` of the largest depth inside;
  /// outside if negative.
  Vector3 near_surface(Tool& tool, double depth) {
    const ContactSurface& surface = model_->contact_surface();
    const auto count = static_cast<double>(surface.triangles().size());
    int t = static_cast<int>(random_.uniform(0.0, count));
    tool.crosses = chance(0.03);
    for (int trial = 0; trial < 20 && !tool.crosses && surface.normal(t).dot(surface.normal(tool.triangle)) < 0.5;
         ++trial)
      t = static_cast<int>(random_.uniform(0.0, count));
    tool.triangle = t;
    const Triangle& v = surface.triangle(t);
    const double a = random_.uniform(), b = random_.uniform(0.0, 1.0 - a);
    const Vector3 p = a * surface.position(v[0]) + b * surface.position(v[1]) + (1.0 - a - b) * surface.position(v[2]);
    const double deepest = std::min({0.3 * thickness_, 2e-3 + tool.radius, 8e-3});
    return model_->to_world() * Vector3(p + (tool.radius - depth * deepest) * surface.normal(t));
  }

  Vector3 in_model(const Vector3& p) const { return model_->to_world().inverse() * p; }
  /// Signed distance of a position from the body at rest [m].
  double height(const Vector3& p) const { return model_->contact_surface().closest(in_model(p)).distance; }

  void move(Tool& tool, int k, bool hold) {
    tool.state.time = 1e-3 * k;
    tool.state.valid = true;
    if (hold) {
      tool.state.position = tool.to;
      return;
    }
    if (tool.done >= tool.length + tool.pause) {
      tool.from = tool.to;
      tool.to = near_surface(tool, chance(0.25) ? -1.0 : random_.uniform(0.1, 1.0));
      const double speed = tool.radius * logarithmic(0.01, 3.0);  // per tick
      tool.length = static_cast<int>(std::clamp(std::ceil((tool.to - tool.from).norm() / speed), 1.0, 150.0));
      tool.pause = chance(0.3) ? 50 : 0;
      tool.done = 0;
    }
    ++tool.done;
    tool.state.position =
        tool.from + std::min(1.0, static_cast<double>(tool.done) / tool.length) * (tool.to - tool.from);
    if (chance(0.001)) tool.unreadable = 1 + static_cast<int>(random_.uniform(0.0, 20.0));
    if (tool.unreadable > 0) {
      --tool.unreadable;
      tool.state.valid = false;
    } else if (chance(0.0005)) {
      tool.state.position[1] = std::numeric_limits<double>::quiet_NaN();
    }
  }

  void tick(TortureCounts& counts) {
    std::vector<ToolState> states;
    for (const Tool& tool : tools_) states.push_back(tool.state);
    const auto forces = servo_->tick(states);
    ++counts.ticks;
    double motion = 0.0;  // of all tools, now and of late
    int pressing = 0;
    for (std::size_t t = 0; t < tools_.size(); ++t) {
      Tool& tool = tools_[t];
      const double own = states[t].position.allFinite() ? (states[t].position - tool.last_position).norm() : 0.0;
      tool.pace += (own - tool.pace) / 30.0;
      motion += own + tool.pace;
      pressing += servo_->tick_view().contact_force(t).norm() > 0.0;
    }
    for (std::size_t t = 0; t < tools_.size(); ++t) check_tick(t, forces[t], motion, pressing, counts);
  }

  void check_tick(std::size_t t, const GatedForce& rendered, double motion, int pressing, TortureCounts& counts) {
    Tool& tool = tools_[t];
    const Vector3 force = servo_->tick_view().contact_force(t);
    tool.status = rendered.status;
    if (!force.allFinite() || !rendered.force().allFinite() || rendered.force().norm() > peak_force_ * (1.0 + 1e-12))
      note(counts.non_finite, "non-finite", t);
    const bool readable = tool.state.valid && tool.state.position.allFinite();
    const bool restarts = tool.status.has(StatusFlag::reacquired);
    counts.reacquired += restarts;
    tool.readable = readable && !restarts ? tool.readable + 1 : 0;
    const bool flagged =
        tool.status.has(StatusFlag::degraded_model) || tool.status.has(StatusFlag::solver_not_converged);
    const bool opens = tool.status.has(StatusFlag::ramping);  // the force gate
    counts.not_converged += tool.status.has(StatusFlag::solver_not_converged);
    counts.degraded += tool.status.has(StatusFlag::degraded_model);
    const bool presses = force.norm() > 0.0;
    counts.pressed += presses;
    if (tool.readable > 1 && !flagged && !opens && !presses && pressing == 0 && !is_open_ &&
        height(tool.state.position) < -1e-6 * thickness_)
      note(counts.lost, "lost", t);
    const double largest = std::max(force.norm(), tool.force.norm());
    tool.tangled = (tool.tangled && presses) || tool.crosses || largest > peak_force_;
    // A tool that pulls at a fold of the surface from outside, or slips, leaves with a jump.
    const bool presses_on = readable && height(tool.state.position) < tool.radius;
    const double share = friction_ > 0.0 ? 0.3 : 0.1;
    if (tool.readable > 30 && !flagged && !tool.tangled && presses_on &&
        (force - tool.force).norm() > 2.0 * stiffness_ * motion + share * largest + 0.05) {
      note(counts.jumps, "jump", t);
      counts.caught_up += tool.flagged;
    }
    tool.flagged = flagged;
    tool.force = force;
    if (readable) tool.last_position = tool.state.position;
  }

  /// The proxies against the surface as it is deformed by all forces.
  void check_sides(TortureCounts& counts) {
    const ContactSurface& surface = model_->contact_surface();
    const VectorX u = model_->displacement(servo_->read_snapshot().vertex_forces());
    std::vector<Vector3> positions = surface.positions();
    for (std::size_t v = 0; v < positions.size(); ++v)
      positions[v] += u.segment<3>(3 * Index{model_->touchable_nodes()[v]});
    const ContactSurface deformed(std::move(positions), surface.triangles());
    const std::vector<bool> inverted = inverted_nodes(u);
    for (std::size_t t = 0; t < tools_.size(); ++t) {
      const Tool& tool = tools_[t];
      if (tool.status.has(StatusFlag::coarse_contact) || tool.force.norm() == 0.0) continue;
      const auto closest = deformed.closest(in_model(servo_->tick_view().proxy(t)));
      if (!(closest.distance < -1e-9 * thickness_)) continue;
      // A sphere smaller than the facets is in a dent that they do not show. It is pushed out of it.
      const Vector3 push = model_->to_world().linear().transpose() * tool.force;
      if (tool.radius < edge_ && push.dot(deformed.normal(closest.triangle)) > 0.0) continue;
      const Triangle& v = surface.triangle(closest.triangle);
      const bool everted = std::any_of(v.begin(), v.end(), [&](int i) {
        return inverted[static_cast<std::size_t>(model_->touchable_nodes()[static_cast<std::size_t>(i)])];
      });
      if (everted)
        ++counts.everted;
      else
        note(counts.inside, "inside", t);
    }
  }

  /// Nodes of the tetrahedra that a displacement turns inside out. The linear model allows that, and the surface there
  /// has no inside and outside: its normals point into the body.
  std::vector<bool> inverted_nodes(const VectorX& u) const {
    const auto& mesh = model_->mesh();
    const auto volume = [&](const auto& element, double share) {
      std::array<Vector3, 4> x;
      for (std::size_t a = 0; a < 4; ++a)
        x[a] = mesh.positions[static_cast<std::size_t>(element[a])] + share * u.segment<3>(3 * Index{element[a]});
      return (x[1] - x[0]).cross(x[2] - x[0]).dot(x[3] - x[0]);
    };
    std::vector<bool> inverted(mesh.positions.size(), false);
    for (const auto& element : mesh.elements)
      if (volume(element, 0.0) * volume(element, 1.0) < 0.0)
        for (const auto node : element) inverted[static_cast<std::size_t>(node)] = true;
    return inverted;
  }

  void note(long& count, const char* what, std::size_t t) {
    ++count;
    if (!print_ || ++notes_ > 6) return;
    const Tool& tool = tools_[t];
    std::printf(
        "seed %llu %s, edge %.2f mm, thickness %.2f mm, %zu tools, friction %.2f: %s, tool %zu, radius %.2f mm, tick "
        "%.0f, "
        "force %.4f N, before %.4f N, rows %d, depth %.3f mm\n",
        static_cast<unsigned long long>(seed_), name_.c_str(), 1e3 * edge_, 1e3 * thickness_, tools_.size(), friction_,
        what, t, 1e3 * tool.radius, 1e3 * tool.state.time, servo_->tick_view().contact_force(t).norm(),
        tool.force.norm(), servo_->tick_view().contact_rows(), -1e3 * height(tool.state.position));
  }

  testing::Random random_;
  std::uint64_t seed_;
  bool print_, is_open_ = false;
  double edge_ = 0.0, thickness_ = 0.0, friction_ = 0.0, stiffness_ = 0.0, peak_force_ = 0.0;
  std::string name_;
  int notes_ = 0;
  std::unique_ptr<Model> model_;
  std::vector<Tool> tools_;
  std::unique_ptr<HapticServo> servo_;
};

/// Every tenth session throws a mass.
inline TortureCounts torture(std::uint64_t first, int sessions, int ticks, bool print) {
  TortureCounts counts;
  for (int i = 0; i < sessions; ++i) {
    TortureSession session(first + static_cast<std::uint64_t>(i), print);
    i % 10 == 9 ? session.throw_mass(ticks / 4, counts) : session.run(ticks, counts);
  }
  return counts;
}

}  // namespace test
