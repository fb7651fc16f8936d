#include <limits>
#include <palpate/core/platform.hpp>
#include <thread>
#include <type_traits>

#include "catch.hpp"

using namespace palpate;

static_assert(!std::is_copy_constructible_v<FlushDenormals> && !std::is_copy_assignable_v<FlushDenormals>);

#if defined(PALPATE_HAS_MXCSR) || defined(__aarch64__)
namespace {

/// min/2, computed when called: denormal, or zero when results are flushed.
double half_of_smallest() {
  volatile double x = std::numeric_limits<double>::min(), half = 0.5;
  volatile double product = x * half;
  return product;
}

/// denorm_min * 1e300: a normal number, or zero when inputs are flushed.
double grown_denormal() {
  volatile double x = std::numeric_limits<double>::denorm_min(), big = 1e300;
  volatile double product = x * big;
  return product;
}

}  // namespace

TEST_CASE("denormals are flushed to zero inside FlushDenormals and kept outside", "[core][realtime]") {
  REQUIRE(half_of_smallest() > 0.0);
  REQUIRE(grown_denormal() > 0.0);
  {
    const FlushDenormals flush;
    CHECK(half_of_smallest() == 0.0);
    CHECK(grown_denormal() == 0.0);
    {
      const FlushDenormals again;
      CHECK(half_of_smallest() == 0.0);
    }
    CHECK(half_of_smallest() == 0.0);  // an inner scope restores the mode it found, not the default
  }
  CHECK(half_of_smallest() > 0.0);
  CHECK(grown_denormal() > 0.0);
}

TEST_CASE("an exception restores the mode too", "[core][realtime]") {
  try {
    const FlushDenormals flush;
    throw 1;
  } catch (int) {
    CHECK(half_of_smallest() > 0.0);
  }
}

TEST_CASE("normal numbers are not changed", "[core][realtime]") {
  const FlushDenormals flush;
  volatile double smallest = std::numeric_limits<double>::min(), one = 1.0;
  CHECK(smallest * one == std::numeric_limits<double>::min());
}

TEST_CASE("another thread keeps its own mode", "[core][realtime]") {
  double seen = 0.0;
  std::thread other;
  other = std::thread([&seen] {
    const FlushDenormals flush;
    seen = half_of_smallest();
  });
  other.join();
  CHECK(seen == 0.0);
  CHECK(half_of_smallest() > 0.0);
}
#endif
