// E10: every allocation of a set-up fails in turn. Nothing leaks, what existed stays, and the set-up can be tried
// again.
#include "extremes/verdict.hpp"

#include <cerrno>
#include <cstdio>

using namespace test;

namespace {

/// Heap calls of this thread while `counting`; the one with the number `fails_at` fails, and with `all_after` every
/// later one too.
struct FailingHeap {
  std::int64_t calls = 0, fails_at = -1;
  std::int64_t live = 0;  ///< blocks
  bool counting = false, all_after = false;

  bool refuses() noexcept {
    if (!counting) return false;
    const std::int64_t number = calls++;
    return fails_at >= 0 && (number == fails_at || (all_after && number > fails_at));
  }
};
constinit thread_local FailingHeap heap{};

}  // namespace

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define PALPATE_TEST_HEAP_FAILS

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

static void* counted(void* block) noexcept {
  if (block != nullptr) ++heap.live;
  return block;
}
void* malloc(std::size_t size) noexcept {
  return heap.refuses() ? nullptr : counted(__libc_malloc(size));
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  return heap.refuses() ? nullptr : counted(__libc_calloc(count, size));
}
void* realloc(void* block, std::size_t size) noexcept {
  if (heap.refuses()) return nullptr;
  void* const got = __libc_realloc(block, size);
  if (block == nullptr) return counted(got);
  if (size == 0) --heap.live;
  return got;
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return heap.refuses() ? nullptr : counted(__libc_memalign(alignment, size));
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) noexcept {
  void* const got = memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *block = got;
  return 0;
}
void free(void* block) noexcept {
  if (block != nullptr) --heap.live;
  __libc_free(block);
}
}
#endif

namespace {

struct Attempt {
  bool finished = false, out_of_memory = false;
  std::int64_t calls = 0, leaked = 0;
};
/// Runs work() with the heap failing at a number; -1: never.
template <class Work>
Attempt with_failing_heap(std::int64_t at, bool all_after, Work work) {
  Attempt a;
  const std::int64_t before = heap.live;
  heap = {.calls = 0, .fails_at = at, .live = before, .counting = true, .all_after = all_after};
  try {
    work();
    a.finished = true;
  } catch (const std::bad_alloc&) {
    a.out_of_memory = true;
  } catch (...) {}
  heap.counting = false;
  a.calls = heap.calls;
  a.leaked = heap.live - before;
  return a;
}

Scene small_scene(double pull) {
  return Scene().fix("fixed").touch("end").gravity({0.0, 0.0, -9.81}).point_load("end", {pull, 0.2, -0.3});
}

}  // namespace

#ifdef PALPATE_TEST_HEAP_FAILS

TEST_CASE("a set-up in which any one allocation fails, or all from some on, throws bad_alloc and leaks nothing",
          "[extreme][E10]") {
  const LinearElastic material{5e3, 0.3, 1000.0};
  const Mesh<Tet4> mesh = two_cubes();
  std::int64_t tried = 0, survived = 0;
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    VectorX answer(36);
    const auto set_up = [&] { answer = make_model(policy, mesh, small_scene(0.1), material)->displacement(); };
    set_up();  // what is made once per program is made now
    const VectorX expected = answer;
    const Attempt whole = with_failing_heap(-1, false, set_up);
    REQUIRE(whole.finished);
    REQUIRE(whole.leaked == 0);
    REQUIRE(whole.calls > 100);
    for (bool all_after : {false, true})
      for (std::int64_t at = 0; at < whole.calls; ++at) {
        answer.setZero();
        const Attempt a = with_failing_heap(at, all_after, set_up);
        // Some do without: a sort that wanted a buffer. Then the answer is the same.
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

TEST_CASE("a model whose change runs out of memory is as it was", "[extreme][E10]") {
  for (PolicyName policy : extreme_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, two_cubes(), small_scene(0.1), LinearElastic{5e3, 0.3, 1000.0});
    const VectorX before = model->displacement();
    const Matrix3 compliance = model->compliance(0, 1);
    const Scene other = small_scene(0.4);
    const Attempt whole = with_failing_heap(-1, false, [&] { model->set_conditions(other); });
    REQUIRE(whole.finished);
    const VectorX after = model->displacement();
    REQUIRE(after != before);
    model->reset();
    REQUIRE(model->displacement() == before);
    for (std::int64_t at = 0; at < whole.calls; ++at) {
      const Attempt a = with_failing_heap(at, false, [&] { model->set_conditions(other); });
      INFO("allocation " << at << " of " << whole.calls);
      CHECK(a.out_of_memory != a.finished);
      REQUIRE(model->displacement() == (a.finished ? after : before));
      REQUIRE(model->compliance(0, 1) == compliance);
      if (a.finished) model->reset();
    }
    model->set_conditions(other);
    CHECK(model->displacement() == after);
  }
}

#endif
