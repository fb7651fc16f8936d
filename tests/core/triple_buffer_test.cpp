// One writer, one reader: the newest complete value, in order.
#include <palpate/core/thread_exchange.hpp>

#include <cstdint>
#include <thread>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("the newest published value is read exactly once", "[core][triple_buffer]") {
  TripleBuffer<int> buffer;
  CHECK_FALSE(buffer.update());
  CHECK(buffer.front() == 0);
  buffer.back() = 1;
  CHECK_FALSE(buffer.update());  // not published
  buffer.publish();
  CHECK(buffer.front() == 0);  // update() was not called
  CHECK(buffer.update());
  CHECK(buffer.front() == 1);
  CHECK_FALSE(buffer.update());
  CHECK(buffer.front() == 1);
  for (int i = 2; i < 10; ++i) {
    buffer.back() = i;
    buffer.publish();
  }
  CHECK(buffer.update());
  CHECK(buffer.front() == 9);
  for (int i = 10; i < 1000; ++i) {
    buffer.back() = i;
    CHECK(buffer.front() == i - 1);  // the writer never touches what is being read
    buffer.publish();
    CHECK(buffer.update());
    CHECK(buffer.front() == i);
  }
}

TEST_CASE("two threads: no torn value, none out of order, the last value is received", "[core][triple_buffer]") {
  struct Value {
    std::array<std::uint64_t, 64> words{};
  };
  constexpr std::uint64_t last = 500'000;
  TripleBuffer<Value> buffer;
  std::thread writer([&] {
    for (std::uint64_t i = 1; i <= last; ++i) {
      buffer.back().words.fill(i);
      buffer.publish();
      if (i % 64 == 0) std::this_thread::yield();
    }
  });
  std::uint64_t torn = 0, backwards = 0, seen = 0, newest = 0;
  while (newest < last) {
    if (!buffer.update()) {
      std::this_thread::yield();
      continue;
    }
    const Value& v = buffer.front();
    for (std::uint64_t w : v.words)
      if (w != v.words[0]) ++torn;
    if (v.words[0] <= newest) ++backwards;
    newest = v.words[0];
    ++seen;
  }
  writer.join();
  CHECK(torn == 0);
  CHECK(backwards == 0);
  CHECK(newest == last);
  CHECK(seen > 0);  // the number depends on the load of the machine
}
