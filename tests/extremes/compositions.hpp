// Every kind of tool on a tissue, by a session or a loop of one's own, with and without a worker, alone and in a group.
// The results are checked elsewhere: here nothing may crash, hang, race or give a force that is not finite.
#pragma once

#include <palpate/contact/tissue_group.hpp>
#include <palpate/haptic/background_worker.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/promote.hpp>

#include <array>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <tuple>
#include <utility>
#include <vector>

#include "catch.hpp"

namespace compositions {

using namespace palpate;

inline constexpr std::size_t most_tools = 4;
inline constexpr int ticks = 200;
inline const Vector3 size(0.06, 0.06, 0.03);

/// The tools of one composition.
struct Tools {
  std::string name;
  ToolList list;
  bool grasps = false;
  bool cuts = false;
};

inline std::vector<Tools> kinds_of_tools() {
  const SphereTool sphere{.radius = 6e-3};
  const CapsuleTool capsule(4e-3, 8e-3, {0.0, 1.0, 0.0});
  const ConvexTool plate = ConvexTool::box({16e-3, 12e-3, 4e-3}, 2e-3);
  const BladeTool blade{.edge = {0.0, 0.03, 0.0}, .toughness = 20.0};
  return {{"sphere", sphere},
          {"capsule", capsule},
          {"convex", plate},
          {"grasp", sphere, true},
          {"four tools", {sphere, capsule, plate, sphere}, true},
          {"blade", blade, false, true},
          {"blade and sphere", {blade, sphere}, false, true},
          {"blade and grasp", {sphere, blade}, true, true}};
}

/// Where tool number t of `count` is in a tick: pressed in, moved sideways, lifted, pressed again. Blades go deeper.
inline Vector3 position_of(const Tool& tool, std::size_t t, std::size_t count, int tick) {
  const double side = (static_cast<double>(t) + 0.5) / static_cast<double>(count);
  const int phase = tick % 100;
  const double in = phase < 80 ? std::min(1.0, phase / 40.0) : 1.0 - (phase - 80) / 10.0;
  const bool blade = std::holds_alternative<BladeTool>(tool);
  const double reach = blade ? 0.0 : 4e-3;
  return {side * size[0] + 1e-4 * phase, 0.4 * size[1], size[2] + reach + 1e-3 - (blade ? 12e-3 : 5e-3) * in};
}
/// The state of a tool: unreadable for some ticks, grasping for some.
inline ToolState state_of(const Tools& tools, std::size_t t, int tick) {
  ToolState state;
  state.position = position_of(tools.list[t], t, tools.list.size(), tick);
  state.time = state.now = 1e-3 * tick;
  state.valid = tick % 100 < 50 || tick % 100 >= 56;
  state.buttons = tools.grasps && tick % 100 > 20 && tick % 100 < 70 ? 1u : 0u;
  return state;
}

/// Follows the same path as the loop of one's own; `before` runs in the haptic thread before each read.
class ScriptedDevice {
 public:
  ScriptedDevice() = default;
  ScriptedDevice(const Tools& tools, std::size_t number, std::function<void(int)> before)
      : tools_(&tools), number_(number), before_(std::move(before)) {}
  ToolState read() noexcept {
    if (before_) before_(tick_);
    return state_of(*tools_, number_, tick_++);
  }
  Status write(const GatedForce& force) noexcept {
    finite_ = finite_ && force.force().allFinite() && force.torque().allFinite();
    return {};
  }
  DeviceLimits limits() const noexcept { return {.stiffness = 1000.0}; }
  void start() {}
  void stop() noexcept {}
  bool wrote_only_finite() const noexcept { return finite_; }

 private:
  const Tools* tools_ = nullptr;
  std::size_t number_ = 0;
  std::function<void(int)> before_;
  int tick_ = 0;
  bool finite_ = true;
};
static_assert(HapticDevice<ScriptedDevice>);

template <class Model>
Model make_block() {
  using Material = typename Model::MaterialType;
  const auto mesh = copy_mesh<typename Model::ElementType>(box_tet4(size, {5, 5, 3}));
  const Scene scene = Scene().fix("z0").touch("z1");
  return Model(mesh, scene, Material{5e3, 0.4, 1000.0});
}

/// One model, as the tissue of a session or as a member of a group, beside another one that no tool reaches.
template <class Model>
struct Body {
  Model model;
  std::unique_ptr<Model> second;

  explicit Body(bool grouped) : model(make_block<Model>()) {
    if (!grouped) return;
    second.reset(new Model(make_block<Model>()));  // it cannot be moved
    second->set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.1, 0.0, 0.0)));
  }
  /// Background work, and a cut of the middle of the body in tick 60, where it can be cut.
  void between_ticks(int tick, bool steps) {
    if constexpr (HasBackgroundWork<Model>)
      if (steps && tick % 8 == 7) {
        model.background_work();
        if (second) second->background_work();
      }
    if constexpr (requires { model.cut_report(); })
      if (tick == 60) model.cut(BladeSweep{{0.031, -1, 0.01}, {0.031, 1, 0.01}, {0.031, -1, 1}, {0.031, 1, 1}});
  }
  void reset() {
    model.reset();
    if (second) second->reset();
  }
};

template <class Tissue>
void run_own_loop(Tissue& tissue, const Tools& tools, const ServoOptions& options, bool paced,
                  const std::function<void(int)>& between, const std::function<void()>& reset) {
  HapticServo servo(tissue, tools.list, options);
  for (int tick = 0; tick < ticks; ++tick) {
    if (tick == 150) {
      servo.reset();
      reset();
    }
    between(tick);
    std::array<ToolState, most_tools> states;
    for (std::size_t t = 0; t < tools.list.size(); ++t) states[t] = state_of(tools, t, tick);
    for (const GatedForce& f : servo.tick({states.data(), tools.list.size()}))
      REQUIRE((f.force().allFinite() && f.torque().allFinite()));
    if (paced) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
}

/// Two runs of a session, with a reset of the tissue in between.
template <class Tissue>
void run_session(Tissue& tissue, const Tools& tools, const ServoOptions& given, const std::function<void(int)>& between,
                 const std::function<void()>& reset) {
  std::array<ScriptedDevice, most_tools> devices;
  for (std::size_t t = 0; t < tools.list.size(); ++t)
    devices[t] = ScriptedDevice(tools, t, t == 0 ? between : std::function<void(int)>());
  ServoOptions options = given;
  options.devices.clear();
  const auto run = [&](auto&&... device) {
    HapticSession session(std::tie(device...), tissue, tools.list, options);
    for (int half = 0; half < 2; ++half) {
      session.run({.duration = 1e-3 * ticks / 2, .paced = false});
      reset();
    }
  };
  switch (tools.list.size()) {
    case 1:
      run(devices[0]);
      break;
    case 2:
      run(devices[0], devices[1]);
      break;
    default:
      run(devices[0], devices[1], devices[2], devices[3]);
  }
  for (const ScriptedDevice& device : devices) CHECK(device.wrote_only_finite());
}

/// All compositions of a model of a block.
template <class Model>
void run_all() {
  constexpr bool can_be_cut = requires(Model & m) {
    m.cut_report();
  };
  bool rough = false;
  for (const Tools& tools : kinds_of_tools()) {
    if (tools.cuts && !can_be_cut) continue;
    for (const bool own_loop : {true, false})
      for (const bool with_worker : {false, true})
        for (const bool grouped : {false, true}) {
          if (grouped && own_loop != with_worker) continue;
          INFO(tools.name << (own_loop ? ", own loop" : ", session")
                          << (with_worker ? ", worker" : ", steps in the loop")
                          << (grouped ? ", in a group" : ", alone"));
          Body<Model> body(grouped);
          std::optional<BackgroundWorker> worker;
          if (with_worker) worker.emplace(body.model);
          std::optional<BackgroundWorker> second_worker;
          if (with_worker && body.second) second_worker.emplace(*body.second);
          ServoOptions options;
          options.devices = {{.stiffness = 1000.0}};
          options.grasp_buttons = tools.grasps ? 1u : 0u;
          options.contact.friction = std::exchange(rough, !rough) ? 0.4 : 0.0;
          const auto between = [&](int tick) { body.between_ticks(tick, !with_worker); };
          const auto reset = [&] { body.reset(); };
          const auto run = [&](auto&& tissue) {
            if (own_loop)
              run_own_loop(tissue, tools, options, with_worker, between, reset);
            else
              run_session(tissue, tools, options, between, reset);
          };
          if (body.second)
            run(TissueGroup(body.model, *body.second));
          else
            run(body.model);
        }
  }
}

}  // namespace compositions
