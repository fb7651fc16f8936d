// Draws the organ beside the window, which never waits for it.
#pragma once

#include <palpate/core/thread_exchange.hpp>

#include "organ.hpp"

#include <atomic>
#include <mutex>
#include <thread>

namespace live {

/// Computes the surface of an organ in a thread of its own, for the newest snapshot that the window has asked for. A
/// cut may keep this thread waiting for half a second; the window shows the surface before until the new one is there.
/// The organ must outlive it.
class SurfaceMaker {
 public:
  /// Draws the organ once, in the calling thread, so that there is always a surface.
  SurfaceMaker(Organ& organ, const ServoSnapshot& snapshot, Field field);
  ~SurfaceMaker();
  SurfaceMaker(const SurfaceMaker&) = delete;
  SurfaceMaker& operator=(const SurfaceMaker&) = delete;

  // The thread of the window; these two never wait
  /// Asks for the surface of this snapshot, in place of one that was not begun yet.
  void ask(const ServoSnapshot& snapshot, Field field);
  /// The newest surface that is complete; valid until the next call.
  const DrawnSurface& newest() noexcept;
  /// Uses the organ while it is not drawn. Waits.
  template <class Use>
  void between_surfaces(Use&& use) {
    const std::scoped_lock lock(drawing_);
    use();
  }

 private:
  struct Wish {
    ServoSnapshot snapshot;
    Field field = Field::displacement;
  };
  void run();

  Organ* organ_;
  TripleBuffer<Wish> wishes_;
  TripleBuffer<DrawnSurface> made_;
  std::mutex drawing_;
  std::atomic<unsigned> asked_{0};
  std::atomic<bool> ends_{false};
  std::thread thread_;
};

}  // namespace live
