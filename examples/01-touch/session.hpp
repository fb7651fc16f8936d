// The two threads of a haptic program: the haptic thread at 1000 Hz and the rendering thread at 30 Hz.
#pragma once

#include <palpate/device/recorder.hpp>
#include "scene.hpp"

#include <chrono>
#include <cstdio>
#include <thread>

namespace touch {

/// State stored by the rendering thread: everything needed to draw the organ at one moment.
struct Frame {
  double time = 0.0;                ///< [s] of the device
  VectorX displacement;             ///< 3 per node [m]
  Vector3 force = Vector3::Zero();  ///< of the tissue on the tool [N]
};

struct Recording {
  LoopReport loop;
  std::vector<RecordedTick> ticks;  ///< every pose read from the device and every force written to it
  std::vector<Frame> frames;
};

/// A line on the terminal that overwrites itself.
inline void show_progress(const LoopProgress& p) {
  const int done = static_cast<int>(30.0 * p.fraction);
  std::fprintf(stderr, "\r  [%.*s%.*s] %5.1f s  %5.3f N ", done, "##############################", 30 - done,
               "..............................", p.elapsed, p.force);
}

/// Reads the newest snapshot of the haptic thread and computes the displacement of all nodes from it: one
/// back-substitution. Neither thread waits for the other.
inline bool look(Organ& organ, HapticSession& session, double not_before, Frame& frame) {
  const ServoSnapshot& snapshot = session.snapshot();
  if (snapshot.time < not_before) return false;
  frame.time = snapshot.time;
  frame.force = snapshot.contact_force();
  organ.displacement_with(snapshot, frame.displacement);
  return true;
}

/// Moves a simulated device along the path, in contact with the organ. Paced: in real time, lateness is measured by a
/// wall clock. Unpaced: as fast as possible, in simulated time; every run is the same except for the frames.
inline Recording run(Organ& organ, const TouchPath& path, const Plan& plan, bool paced) {
  MockDevice hand(path, {.clock = paced ? DeviceClock::wall : DeviceClock::simulated});  // 3.3 N, 500 N/m
  Recorder device(hand, static_cast<std::size_t>(1000.0 * plan.seconds) + 1);
  HapticSession session(device, organ, tool);
  session.start({.duration = plan.seconds, .paced = paced, .real_time = true});

  // Meanwhile, this thread works as a renderer. It keeps at most 600 pictures of a long session.
  const double interval = std::max(1.0 / 30.0, plan.seconds / 600.0);
  const auto pause =
      paced ? std::chrono::microseconds(static_cast<int>(1e6 * interval)) : std::chrono::microseconds(50);
  Recording recording;
  Frame frame;
  frame.displacement.resize(3 * organ.mesh().node_count());
  for (double next = 0.0; session.running(); std::this_thread::sleep_for(pause))
    if (look(organ, session, next, frame)) {
      recording.frames.push_back(frame);
      next = frame.time + (paced ? 0.5 : 1.0) * interval;  // paced: the sleep already provides the interval
      show_progress(session.progress());
    }

  recording.loop = session.stop();
  recording.ticks = device.ticks();
  if (look(organ, session, 0.0, frame)) recording.frames.push_back(frame);
  std::fprintf(stderr, "\r%70s\r", "");
  return recording;
}

}  // namespace touch
