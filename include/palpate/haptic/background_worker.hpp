// The background thread of a tissue: time steps of moving tissue, cuts and the updates that follow them.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

#include <cstdint>
#include <memory>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// Statistics of a worker since its start.
struct WorkerReport {
  std::uint64_t pieces = 0;    ///< pieces of work: steps, cuts
  std::uint64_t late = 0;      ///< pieces that took longer than the interval to the next
  double worst_seconds = 0.0;  ///< of one piece
  double mean_seconds = 0.0;
  /// Simulated time over wall time: 1 keeps up; below 1 the tissue moves in slow motion. Static forces stay right. 1
  /// for work without a prescribed pace.
  double rate = 1.0;
  std::string failure;  ///< message of the exception that ended the work; empty: none
};

/// Does the background work of a tissue (HasBackgroundWork) in its own thread, from construction to `stop` or
/// destruction. If a piece takes longer than the interval to the next, the next follows immediately, and lost time is
/// not made up; `report_slow` of the tissue is then called, and ticks report slow_tissue. If a piece throws, for
/// example because memory is short, the work ends: `report_failed` of the tissue is called, ticks report
/// stalled_tissue, and the exception is kept for `rethrow_failure`. For a tissue without background work there is no
/// thread. Refers to the tissue, which must outlive it.
class BackgroundWorker {
 public:
  template <class Tissue>
  explicit BackgroundWorker(Tissue& tissue) : BackgroundWorker(&tissue, functions_of<Tissue>()) {}
  /// Ends the thread as `stop` does.
  ~BackgroundWorker();
  BackgroundWorker(const BackgroundWorker&) = delete;
  BackgroundWorker& operator=(const BackgroundWorker&) = delete;

  /// Ends the thread after the piece of work in progress.
  void stop();
  /// Statistics so far. For any thread; does not wait for a piece of work.
  WorkerReport report() const;
  /// Whether the work has ended because a piece threw. For any thread; never waits.
  bool failed() const noexcept;
  /// Throws again what that piece threw; nothing if none did. Call it after `stop`, or when `failed`.
  void rethrow_failure() const;

 private:
  struct Functions {
    BackgroundStep (*work)(void*) = nullptr;
    void (*report_slow)(void*, bool) noexcept = nullptr;
    void (*report_failed)(void*, bool) noexcept = nullptr;
  };
  struct Thread;

  template <class Tissue>
  static Functions functions_of() noexcept {
    static_assert(detail::HasWorkHooks<Tissue>,
                  "palpate: this tissue needs background_work(), report_slow(bool) noexcept and report_failed(bool) "
                  "noexcept; derive it from TissueAdaptor, which forwards those of another tissue, or from "
                  "StillTissue");
    Functions f;
    if constexpr (HasBackgroundWork<Tissue>)
      f.work = [](void* t) { return static_cast<Tissue*>(t)->background_work(); };
    if constexpr (!std::same_as<decltype(std::declval<Tissue&>().report_slow(true)), NoHook>)
      f.report_slow = [](void* t, bool slow) noexcept { static_cast<Tissue*>(t)->report_slow(slow); };
    if constexpr (!std::same_as<decltype(std::declval<Tissue&>().report_failed(true)), NoHook>)
      f.report_failed = [](void* t, bool failed) noexcept { static_cast<Tissue*>(t)->report_failed(failed); };
    return f;
  }
  BackgroundWorker(void* tissue, const Functions& functions);
  void run();
  bool work(BackgroundStep& done) noexcept;

  void* tissue_;
  Functions functions_;
  std::unique_ptr<Thread> thread_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/background_worker.ipp>
#endif
