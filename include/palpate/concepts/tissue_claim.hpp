// One servo at a time for a tissue that moves or is cut.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <atomic>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// Whether a servo uses a tissue that can have one only: its surface or compliance changes between ticks, and the
/// forces that a tick leaves replace those of the last one. A tissue with a function `TissueClaim& claim() noexcept` is
/// refused to a second servo. Adaptors forward that of the wrapped tissue.
class TissueClaim {
 public:
  using Taken = std::shared_ptr<std::atomic<bool>>;

  /// True until it is set to false, also when the tissue is gone by then. Throws unsupported when another servo has
  /// taken the tissue.
  Taken acquire() {
    if (taken_->exchange(true))
      raise(SetupErrorKind::unsupported,
            "this tissue keeps a state between ticks (it moves, is cut or stiffens), and another servo or session uses it",
            "Give one servo several tools, or destroy the other one first");
    return taken_;
  }

 private:
  Taken taken_ = std::make_shared<std::atomic<bool>>(false);
};

namespace detail {

/// Holds the claim on a tissue, if it has one, during its lifetime.
class ClaimedTissue {
 public:
  /// Throws as TissueClaim::acquire.
  explicit ClaimedTissue(TissueClaim* claim) : taken_(claim != nullptr ? claim->acquire() : nullptr) {}
  ~ClaimedTissue() {
    if (taken_ != nullptr) taken_->store(false);
  }
  ClaimedTissue(ClaimedTissue&&) = default;
  ClaimedTissue& operator=(ClaimedTissue&&) = delete;

 private:
  TissueClaim::Taken taken_;
};

}  // namespace detail

}}  // namespace palpate
