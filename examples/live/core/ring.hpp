// The only way in which the haptic thread and the window exchange data: a queue without locks.
#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <memory>

namespace live {

/// Bounded first-in first-out queue between one thread that pushes and one that pops. Neither waits or allocates.
template <class T, std::size_t Capacity>
class Ring {
 public:
  /// False, and nothing is stored, when it is full.
  bool push(const T& value) noexcept {
    const std::size_t end = end_.load(std::memory_order_relaxed);
    if (end - begin_.load(std::memory_order_acquire) == Capacity) return false;
    (*items_)[end % Capacity] = value;
    end_.store(end + 1, std::memory_order_release);
    return true;
  }
  /// False when it is empty.
  bool pop(T& value) noexcept {
    const std::size_t begin = begin_.load(std::memory_order_relaxed);
    if (begin == end_.load(std::memory_order_acquire)) return false;
    value = (*items_)[begin % Capacity];
    begin_.store(begin + 1, std::memory_order_release);
    return true;
  }

 private:
  std::unique_ptr<std::array<T, Capacity>> items_ = std::make_unique<std::array<T, Capacity>>();
  alignas(64) std::atomic<std::size_t> begin_{0};
  alignas(64) std::atomic<std::size_t> end_{0};
};

}  // namespace live
