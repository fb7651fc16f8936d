// Latest-value exchange between one writer and one reader thread.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <atomic>

namespace palpate { inline namespace PALPATE_ABI {

/// Single writer, single reader, lock-free, never waits: the writer fills `back()` and publishes, the reader gets the
/// newest complete value. Both sides own one slot, the third is exchanged atomically. Where every value counts, use
/// SpscRing. O(1) per call, no copy.
template <class T>
class TripleBuffer {
 public:
  /// Copies `value` into all slots; before the two threads begin.
  void fill(const T& value) { slots_.fill(value); }

  /// Slot of the writer; contains what was written two or three publications ago.
  T& back() noexcept { return slots_[back_]; }
  /// Makes the writer's slot the newest value.
  void publish() noexcept { back_ = middle_.exchange(back_ | fresh, std::memory_order_acq_rel) & index_mask; }
  /// Takes the newest value if there is one; true when it is new. `front()` is then valid until the next call.
  bool update() noexcept {
    if ((middle_.load(std::memory_order_relaxed) & fresh) == 0) return false;
    front_ = middle_.exchange(front_, std::memory_order_acq_rel) & index_mask;
    return true;
  }
  const T& front() const noexcept { return slots_[front_]; }
  T& front() noexcept { return slots_[front_]; }

 private:
  static constexpr unsigned fresh = 4, index_mask = 3;
  std::array<T, 3> slots_{};
  unsigned back_ = 0;
  std::atomic<unsigned> middle_{1};
  unsigned front_ = 2;
};

}}  // namespace palpate
