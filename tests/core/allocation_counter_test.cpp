// Tests that count allocations must be able to fail.
#include <palpate/testing/allocation_counter.hpp>

#include <new>
#include <vector>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("allocations are counted if malloc can be replaced", "[core][allocation]") {
#if defined(__GLIBC__) && !defined(PALPATE_SANITIZER_HAS_MALLOC)
  REQUIRE(testing::allocations_are_counted());
  const testing::AllocationScope scope;
  std::vector<double> some(100, 1.0);
  some.shrink_to_fit();
  CHECK(scope.allocations() == 1);
  some.resize(1000);
  CHECK(scope.allocations() == 2);
  CHECK(scope.frees() == 1);
  CHECK(scope.live() == 1);
  for (bool and_later : {false, true}) {
    std::vector<double> first, second, third;
    bool failed = false, failed_again = false;
    {
      const testing::FailingHeap failing(1, and_later);
      first.resize(10);
      try {
        second.resize(10);
      } catch (const std::bad_alloc&) {
        failed = true;
      }
      try {
        third.resize(10);
      } catch (const std::bad_alloc&) {
        failed_again = true;
      }
    }
    CHECK(first.size() == 10);
    CHECK(failed);
    CHECK(failed_again == and_later);
    second.resize(10);
  }
  CHECK(scope.live() == 1);
#else
  SUCCEED("not counted here");
#endif
}
