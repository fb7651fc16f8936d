// Moves a tissue on in a thread of its own.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

#include <cstdint>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// What a tissue's thread has done.
struct TissueThreadReport {
  std::uint64_t steps = 0;
  std::uint64_t late = 0;      ///< steps that took longer than they last
  double worst_seconds = 0.0;  ///< of one step
  double mean_seconds = 0.0;
  /// Tissue time over wall time: 1 keeps up; below, tools feel a tissue that moves in slow motion. Steady forces stay
  /// right.
  double rate = 0.0;
};

/// Calls `advance()` once per step of wall time from construction to destruction; where a step takes longer, the next
/// one follows at once, and lost time is not made up for. Refers to the tissue, which must outlive it.
class TissueThread {
 public:
  template <MovingTissue Tissue>
  explicit TissueThread(Tissue& tissue)
      : TissueThread(
            &tissue, [](void* t) noexcept { static_cast<Tissue*>(t)->advance(); },
            [](const void* t) noexcept -> double { return static_cast<const Tissue*>(t)->step(); }) {}
  ~TissueThread();
  TissueThread(const TissueThread&) = delete;
  TissueThread& operator=(const TissueThread&) = delete;

  /// Ends after the step in work. What it did may be read then.
  void stop();
  /// After stop().
  const TissueThreadReport& report() const noexcept { return report_; }

 private:
  struct Thread;
  TissueThread(void* tissue, void (*advance)(void*) noexcept, double (*step)(const void*) noexcept);
  void run() noexcept;

  void* tissue_;
  void (*advance_)(void*) noexcept;
  double (*step_)(const void*) noexcept;
  TissueThreadReport report_;
  std::unique_ptr<Thread> thread_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/haptic/tissue_thread.ipp>
#endif
