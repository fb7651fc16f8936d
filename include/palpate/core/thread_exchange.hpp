// Lock-free exchange between exactly two threads: a queue, and the latest value.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <atomic>
#include <cstddef>

namespace palpate { inline namespace PALPATE_ABI {

/// Bounded first-in first-out queue: one thread pushes and one pops (single producer, single consumer). Neither waits,
/// locks or allocates, so one of them may be the haptic thread. The items are members: put a large ring on the heap.
/// O(1) per call, one copy of an item, whose
/// assignment must not throw or allocate. Where only the newest value counts, TripleBuffer is the better exchange.
template <class T, std::size_t Capacity>
class SpscRing {
 public:
  static_assert(Capacity > 0, "palpate: a ring needs room for one item");

  /// Of the pushing thread. False, and nothing is stored, when it is full.
  bool push(const T& value) noexcept {
    const std::size_t tail = tail_.load(std::memory_order_relaxed);
    if (tail - head_.load(std::memory_order_acquire) == Capacity) return false;
    items_[tail % Capacity] = value;
    tail_.store(tail + 1, std::memory_order_release);
    return true;
  }
  /// Of the popping thread. False, and `value` stays, when it is empty.
  bool pop(T& value) noexcept {
    const std::size_t head = head_.load(std::memory_order_relaxed);
    if (head == tail_.load(std::memory_order_acquire)) return false;
    value = items_[head % Capacity];
    head_.store(head + 1, std::memory_order_release);
    return true;
  }
  /// Of the popping thread.
  bool empty() const noexcept { return head_.load(std::memory_order_relaxed) == tail_.load(std::memory_order_acquire); }

 private:
  std::array<T, Capacity> items_{};
  alignas(64) std::atomic<std::size_t> head_{0};
  alignas(64) std::atomic<std::size_t> tail_{0};
};

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
