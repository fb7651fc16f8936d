// E10: each allocation of a set-up fails in turn. Nothing leaks, existing objects stay unchanged, and the set-up can be
// repeated.
#include "extremes/verdict.hpp"
#include "mesh/two_cubes.hpp"

#include <palpate/testing/allocation_counter.hpp>

#include <cstdio>
#include <new>

using namespace test;

namespace {

struct Attempt {
  bool finished = false, out_of_memory = false;
  std::int64_t calls = 0, leaked = 0;
};
/// Runs work() with the heap failing at allocation `at`, or at that and all later ones; without `at` nothing fails.
template <class Work>
Attempt with_failing_heap(std::optional<std::int64_t> at, bool and_later, Work work) {
  Attempt a;
  const testing::AllocationScope scope;
  try {
    std::optional<testing::FailingHeap> failing;
    if (at) failing.emplace(static_cast<std::uint64_t>(*at), and_later);
    work();
    a.finished = true;
  } catch (const std::bad_alloc&) {
    a.out_of_memory = true;
  } catch (...) {}
  a.calls = static_cast<std::int64_t>(scope.allocations());
  a.leaked = scope.live();
  return a;
}

Scene small_scene(double pull) {
  return Scene().fix("fixed").touch("end").gravity({0.0, 0.0, -9.81}).point_load("end", {pull, 0.2, -0.3});
}

}  // namespace

TEST_CASE("a set-up in which one allocation, or all from one on, fails throws bad_alloc and leaks nothing",
          "[extreme][E10]") {
  if (!testing::allocations_are_counted()) return;
  const LinearElastic material{5e3, 0.3, 1000.0};
  const Mesh<Tet4> mesh = two_cubes();
  std::int64_t tried = 0, survived = 0;
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    VectorX answer(36);
    const auto set_up = [&] { answer = make_model(policy, mesh, small_scene(0.1), material)->displacement(); };
    set_up();  // constructs static data now
    const VectorX expected = answer;
    const Attempt whole = with_failing_heap({}, false, set_up);
    REQUIRE(whole.finished);
    REQUIRE(whole.leaked == 0);
    REQUIRE(whole.calls > 100);
    for (bool all_after : {false, true})
      for (std::int64_t at = 0; at < whole.calls; ++at) {
        answer.setZero();
        const Attempt a = with_failing_heap(at, all_after, set_up);
        // Some failures are tolerated: a sort without its buffer. Then the result is the same.
        const bool good = a.leaked == 0 && (a.out_of_memory || (a.finished && answer == expected));
        ++tried;
        survived += good ? 1 : 0;
        if (!good) {
          INFO("allocation " << at << " of " << whole.calls << (all_after ? " and all after" : ""));
          CHECK(a.leaked == 0);
          CHECK((a.out_of_memory || a.finished));
          CHECK((a.out_of_memory || answer == expected));
        }
      }
    set_up();
    CHECK(answer == expected);
  }
  CHECK(survived == tried);
  std::printf("figure R10: %lld of %lld\n", static_cast<long long>(survived), static_cast<long long>(tried));
}

TEST_CASE("a model is unchanged when a change of conditions runs out of memory", "[extreme][E10]") {
  if (!testing::allocations_are_counted()) return;
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, two_cubes(), small_scene(0.1), LinearElastic{5e3, 0.3, 1000.0});
    const VectorX before = model->displacement();
    const Matrix3 compliance = model->compliance(0, 1);
    const auto remarks = model->report().remarks;
    const Scene other = small_scene(4e3);
    const Attempt whole = with_failing_heap({}, false, [&] { model->set_conditions(other); });
    REQUIRE(whole.finished);
    const VectorX after = model->displacement();
    const auto remarks_after = model->report().remarks;
    REQUIRE(after != before);
    REQUIRE(remarks_after != remarks);
    model->reset();
    REQUIRE(model->displacement() == before);
    for (std::int64_t at = 0; at < whole.calls; ++at) {
      const Attempt a = with_failing_heap(at, false, [&] { model->set_conditions(other); });
      INFO("allocation " << at << " of " << whole.calls);
      CHECK(a.out_of_memory != a.finished);
      REQUIRE(model->displacement() == (a.finished ? after : before));
      REQUIRE(model->compliance(0, 1) == compliance);
      REQUIRE(model->report().remarks == (a.finished ? remarks_after : remarks));
      if (a.finished) model->reset();
    }
    model->set_conditions(other);
    CHECK(model->displacement() == after);
  }
}
