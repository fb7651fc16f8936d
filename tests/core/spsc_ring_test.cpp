// A queue between two threads: all values, in order, none twice.
#include <palpate/core/thread_exchange.hpp>

#include <cstdint>
#include <memory>
#include <thread>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("a ring returns its values in order, refuses one too many, and keeps its place when it wraps",
          "[core][spsc_ring]") {
  SpscRing<int, 3> ring;
  int next = 0, value = -1;
  CHECK(ring.empty());
  CHECK_FALSE(ring.pop(value));
  CHECK(value == -1);
  for (int round = 0; round < 100; ++round) {
    for (int i = 0; i < 3; ++i) CHECK(ring.push(next + i));
    CHECK_FALSE(ring.push(-7));
    for (int i = 0; i < 3; ++i) {
      CHECK(ring.pop(value));
      CHECK(value == next + i);
    }
    CHECK(ring.empty());
    next += 3;
  }
}

TEST_CASE("two threads: no value of a ring is torn, lost, repeated or out of order", "[core][spsc_ring]") {
  struct Item {
    std::array<std::uint64_t, 9> words{};
  };
  constexpr std::uint64_t last = 200'000;
  const auto ring = std::make_unique<SpscRing<Item, 64>>();
  std::thread producer([&] {
    for (std::uint64_t i = 1; i <= last;) {
      Item item;
      item.words.fill(i);
      if (ring->push(item))
        ++i;
      else
        std::this_thread::yield();
    }
  });
  std::uint64_t expected = 1, wrong = 0;
  for (Item item; expected <= last;) {
    if (!ring->pop(item)) {
      std::this_thread::yield();
      continue;
    }
    for (const std::uint64_t w : item.words) wrong += w == expected ? 0 : 1;
    ++expected;
  }
  producer.join();
  CHECK(wrong == 0);
  CHECK(ring->empty());
}
