// Counts the heap calls of a thread, to verify that a tick makes none, and makes one fail, to test how a set-up handles
// it. Eigen calls malloc, so counting operator new is not enough: malloc and its relatives themselves are replaced.
//
// In exactly one source file of a test program, and nowhere in a library:
//   #define PALPATE_COUNT_ALLOCATIONS
//   #include <palpate/testing/allocation_counter.hpp>
// Elsewhere include without the macro. Works with glibc on Linux at any optimisation; with other C libraries and under
// sanitizers (which bring their own malloc) the macro does nothing and allocations_are_counted() is false.
#pragma once

#include <palpate/core/config.hpp>

#include <cstddef>
#include <cstdint>
#include <cstdlib>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Heap calls of this thread since it started. A realloc of a block is one of each.
struct HeapCalls {
  std::uint64_t allocations = 0;
  std::uint64_t frees = 0;
  std::uint64_t failed = 0;  ///< allocations that were made to fail
};

/// The allocation of this thread that is to fail, by its number as counted by HeapCalls; with `and_later` all later
/// ones, too.
struct HeapFailure {
  std::uint64_t number = 0;
  bool armed = false, and_later = false;
};

namespace detail {
inline constinit thread_local HeapCalls heap_calls{};
inline constinit thread_local HeapFailure heap_failure{};

/// Counts an allocation; false if it is to fail.
inline bool heap_allows() noexcept {
  const std::uint64_t number = heap_calls.allocations++;
  const volatile HeapFailure& f = heap_failure;
  if (!f.armed || number < f.number || (number > f.number && !f.and_later)) return true;
  ++heap_calls.failed;
  return false;
}

/// Read as volatile: compilers know malloc and assume that calling it cannot change this variable.
inline HeapCalls heap_calls_now() noexcept {
  const volatile HeapCalls& now = heap_calls;
  return {now.allocations, now.frees, now.failed};
}
}  // namespace detail

/// True when the counter is built into this program.
inline bool allocations_are_counted() noexcept {
  const std::uint64_t before = detail::heap_calls_now().allocations;
  void* volatile memory = std::malloc(1);  // volatile, or the compiler removes malloc and free
  std::free(memory);
  return detail::heap_calls_now().allocations > before;
}

/// Heap calls of the constructing thread since construction:
///   AllocationScope scope;  servo.tick(states);  CHECK(scope.allocations() == 0);
class AllocationScope {
 public:
  std::uint64_t allocations() const noexcept { return detail::heap_calls_now().allocations - start_.allocations; }
  std::uint64_t frees() const noexcept { return detail::heap_calls_now().frees - start_.frees; }
  /// Blocks allocated and not freed; negative if older blocks were freed.
  std::int64_t live() const noexcept {
    const HeapCalls now = detail::heap_calls_now();
    return static_cast<std::int64_t>(now.allocations - start_.allocations) -
           static_cast<std::int64_t>(now.frees - start_.frees) - static_cast<std::int64_t>(now.failed - start_.failed);
  }

 private:
  HeapCalls start_ = detail::heap_calls_now();
};

/// Makes the n-th allocation of this thread from now on fail (n counts from zero), with `and_later` all later ones too,
/// until it goes out of scope: { FailingHeap failing(n); try { set_up(); } catch (const std::bad_alloc&) {} }
class FailingHeap {
 public:
  explicit FailingHeap(std::uint64_t n, bool and_later = false) noexcept {
    volatile HeapFailure& failure = detail::heap_failure;  // as for heap_calls_now
    failure.number = detail::heap_calls_now().allocations + n;
    failure.and_later = and_later;
    failure.armed = true;
  }
  FailingHeap(const FailingHeap&) = delete;
  FailingHeap& operator=(const FailingHeap&) = delete;
  ~FailingHeap() {
    volatile HeapFailure& failure = detail::heap_failure;
    failure.armed = false;
  }
};

}}}  // namespace palpate::testing

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define PALPATE_SANITIZER_HAS_MALLOC 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer) || __has_feature(memory_sanitizer) || \
    __has_feature(leak_sanitizer) || __has_feature(realtime_sanitizer)
#define PALPATE_SANITIZER_HAS_MALLOC 1
#endif
#endif

#if defined(PALPATE_COUNT_ALLOCATIONS) && defined(__GLIBC__) && !defined(PALPATE_SANITIZER_HAS_MALLOC)
#include <cerrno>

extern "C" {
void* __libc_malloc(std::size_t);
void* __libc_calloc(std::size_t, std::size_t);
void* __libc_realloc(void*, std::size_t);
void* __libc_memalign(std::size_t, std::size_t);
void __libc_free(void*);

void* malloc(std::size_t size) noexcept {
  return palpate::testing::detail::heap_allows() ? __libc_malloc(size) : nullptr;
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  return palpate::testing::detail::heap_allows() ? __libc_calloc(count, size) : nullptr;
}
void* realloc(void* memory, std::size_t size) noexcept {
  if (!palpate::testing::detail::heap_allows()) return nullptr;
  if (memory != nullptr) ++palpate::testing::detail::heap_calls.frees;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  return palpate::testing::detail::heap_allows() ? __libc_memalign(alignment, size) : nullptr;
}
void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  return memalign(alignment, size);
}
int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  void* const got = memalign(alignment, size);
  if (got == nullptr) return ENOMEM;
  *memory = got;
  return 0;
}
void free(void* memory) noexcept {
  if (memory != nullptr) ++palpate::testing::detail::heap_calls.frees;
  __libc_free(memory);
}
}
#endif
