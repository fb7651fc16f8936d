// The thread beside the tick: steps of moving tissue, cuts and what follows them.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

#include <cstdint>
#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// What a worker has done so far.
struct WorkerReport {
  std::uint64_t pieces = 0;    ///< of work: steps, cuts
  std::uint64_t late = 0;      ///< pieces that took longer than the time to the next
  double worst_seconds = 0.0;  ///< of one piece
  double mean_seconds = 0.0;
  /// Time of the tissue over that of the clock: 1 keeps up; below, tools feel a tissue that moves in slow motion. Steady
  /// forces stay right. 1 for work that has no pace of its own.
  double rate = 1.0;
};

/// Does the background work of a tissue (HasBackgroundWork) in a thread of its own, from construction to `stop` or
/// destruction. Where a piece takes longer than the time to the next, the next follows at once, and lost time is not
/// made up for; `report_slow` of the tissue is then called, and ticks report slow_tissue. There is no thread for a tissue
/// without background work. Refers to the tissue, which must outlive it.
class BackgroundWorker {
 public:
  template <class Tissue>
  explicit BackgroundWorker(Tissue& tissue) : BackgroundWorker(&tissue, functions_of<Tissue>()) {}
  ~BackgroundWorker();
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

  /// Ends after the piece in work.
  void stop();
  /// So far. Any thread; waits for no piece of work.
  WorkerReport report() const;

 private:
  struct Functions {
    BackgroundStep (*work)(void*) = nullptr;
    void (*report_slow)(void*, bool) noexcept = nullptr;
  };
  struct Thread;

  template <class Tissue>
  static Functions functions_of() noexcept {
    static_assert(detail::HasWorkHooks<Tissue>,
                  "palpate: this tissue needs background_work() and report_slow(bool) noexcept; derive it from "
                  "TissueAdaptor, which hands on those of another tissue, or from StillTissue");
    Functions f;
    if constexpr (HasBackgroundWork<Tissue>)
      f.work = [](void* t) { return static_cast<Tissue*>(t)->background_work(); };
    if constexpr (!std::same_as<decltype(std::declval<Tissue&>().report_slow(true)), NoHook>)
      f.report_slow = [](void* t, bool slow) noexcept { static_cast<Tissue*>(t)->report_slow(slow); };
    return f;
  }
  BackgroundWorker(void* tissue, const Functions& functions);
  void run();

  void* tissue_;
  Functions functions_;
  std::unique_ptr<Thread> thread_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/background_worker.ipp>
#endif
