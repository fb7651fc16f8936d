// The two threads of a haptic program: one that feels, a thousand times a second, and one that looks, thirty times.
#pragma once

#include <palpate/device/recorder.hpp>
#include "scene.hpp"

#include <chrono>
#include <cstdio>
#include <future>

namespace touch {

/// What the looking thread keeps: all that is needed to draw the organ at one moment.
struct Frame {
  double time = 0.0;                ///< [s] of the device
  VectorX displacement;             ///< 3 per node [m]
  Vector3 force = Vector3::Zero();  ///< of the tissue on the tool [N]
};

struct Session {
  LoopReport loop;
  std::vector<RecordedTick> ticks;  ///< every pose the device gave and every force it was told
  std::vector<Frame> frames;
};

/// A line on the terminal that overwrites itself.
inline bool show_progress(const LoopProgress& p) {
  const int done = static_cast<int>(30.0 * p.fraction);
  std::fprintf(stderr, "\r  [%.*s%.*s] %5.1f s  %5.3f N ", done, "##############################", 30 - done,
               "..............................", p.elapsed, p.force);
  return true;
}

/// Takes the newest snapshot that the haptic thread left and computes the displacement of all nodes from it: one
/// back-substitution. Neither thread waits for the other.
inline bool look(Organ& organ, HapticServo& servo, double not_before, Frame& frame) {
  const auto& snapshot = servo.read_snapshot();
  if (snapshot.time < not_before) return false;
  frame.time = snapshot.time;
  frame.force.setZero();
  for (const VertexForce& f : snapshot.vertex_forces()) frame.force -= organ.to_world().linear() * f.force;
  organ.displacement_with(snapshot.vertex_forces(), frame.displacement);
  return true;
}

/// Lets a simulated hand follow the path and feel the organ. Paced: in real time, a wall clock decides what is late.
/// Unpaced: as fast as it goes, in simulated time, the same in every run but for the frames.
inline Session run(Organ& organ, const TouchPath& path, const Plan& plan, bool paced) {
  const DeviceLimits limits{};  // of a common desktop device: 3.3 N, 500 N/m
  ServoOptions servo_options;
  servo_options.device = limits;
  HapticServo servo(organ, tool, servo_options);

  MockDevice hand(path, {.clock = paced ? DeviceClock::wall : DeviceClock::simulated, .limits = limits});
  Recorder device(hand, static_cast<std::size_t>(1000.0 * plan.seconds) + 1);
  LoopOptions options{.rate = 1000.0, .duration = plan.seconds, .paced = paced, .real_time = true};
  options.progress = show_progress;

  Session session;
  auto loop = std::async(std::launch::async, [&] { return run_haptic_loop(device, servo, options); });

  // Meanwhile, this thread does what a renderer does. It keeps no more than 600 pictures of a long session.
  const double interval = std::max(1.0 / 30.0, plan.seconds / 600.0);
  const auto pause =
      paced ? std::chrono::microseconds(static_cast<int>(1e6 * interval)) : std::chrono::microseconds(50);
  Frame frame;
  frame.displacement.resize(3 * organ.mesh().node_count());
  for (double next = 0.0; loop.wait_for(pause) != std::future_status::ready;)
    if (look(organ, servo, next, frame)) {
      session.frames.push_back(frame);
      next = frame.time + (paced ? 0.5 : 1.0) * interval;  // paced, the pause itself keeps the distance
    }

  session.loop = loop.get();
  session.ticks = device.ticks();
  if (look(organ, servo, 0.0, frame)) session.frames.push_back(frame);
  std::fprintf(stderr, "\r%70s\r", "");
  return session;
}

}  // namespace touch
