// One servo at a time for a tissue that moves or is cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <atomic>

namespace palpate { inline namespace PALPATE_ABI {

/// Whether a servo uses a tissue that can have one only: its surface changes between ticks, and the forces that a tick
/// leaves replace those of the last one. A tissue with a function `TissueClaim& claim() noexcept` is refused to a
/// second servo. Adaptors forward that of the wrapped tissue.
class TissueClaim {
 public:
  /// Throws unsupported when another servo has taken it.
  void take() {
    if (taken_.exchange(true))
      raise(SetupErrorKind::unsupported, "this tissue moves or is cut, and another servo or session uses it",
            "Give one servo several tools, or destroy the other one first");
  }
  void release() noexcept { taken_.store(false); }

 private:
  std::atomic<bool> taken_{false};
};

/// Holds the claim on a tissue, if it has one, during its lifetime.
class ClaimedTissue {
 public:
  /// Throws as TissueClaim::take.
  explicit ClaimedTissue(TissueClaim* claim) : claim_(claim) {
    if (claim_ != nullptr) claim_->take();
  }
  ~ClaimedTissue() {
    if (claim_ != nullptr) claim_->release();
  }
  ClaimedTissue(const ClaimedTissue&) = delete;
  ClaimedTissue& operator=(const ClaimedTissue&) = delete;

 private:
  TissueClaim* claim_;
};

}}  // namespace palpate
