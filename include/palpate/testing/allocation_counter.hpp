// Counts the heap calls of a thread, to show that a tick makes none. Eigen calls malloc, so counting operator new is
// not enough: malloc and its relatives themselves are replaced.
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

namespace palpate::inline PALPATE_ABI::testing {

/// Heap calls of this thread since it started.
struct HeapCalls {
  std::uint64_t allocations = 0;
  std::uint64_t frees = 0;
};

namespace detail {
inline constinit thread_local HeapCalls heap_calls{};

/// Read as volatile: compilers know malloc and conclude that a call of it cannot change a variable of ours.
inline HeapCalls heap_calls_now() noexcept {
  const volatile HeapCalls& now = heap_calls;
  return {now.allocations, now.frees};
}
}  // namespace detail

/// True when the counter is built into this program.
inline bool allocations_are_counted() noexcept {
  const std::uint64_t before = detail::heap_calls_now().allocations;
  void* volatile memory = std::malloc(1);  // volatile: or the compiler leaves malloc and free out
  std::free(memory);
  return detail::heap_calls_now().allocations > before;
}

/// Heap calls of the constructing thread since construction:
///   AllocationScope scope;  servo.tick(states);  CHECK(scope.allocations() == 0);
class AllocationScope {
 public:
  std::uint64_t allocations() const noexcept { return detail::heap_calls_now().allocations - start_.allocations; }
  std::uint64_t frees() const noexcept { return detail::heap_calls_now().frees - start_.frees; }

 private:
  HeapCalls start_ = detail::heap_calls_now();
};

}  // namespace palpate::inline PALPATE_ABI::testing

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
  ++palpate::testing::detail::heap_calls.allocations;
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) noexcept {
  ++palpate::testing::detail::heap_calls.allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* memory, std::size_t size) noexcept {
  ++palpate::testing::detail::heap_calls.allocations;
  return __libc_realloc(memory, size);
}
void* memalign(std::size_t alignment, std::size_t size) noexcept {
  ++palpate::testing::detail::heap_calls.allocations;
  return __libc_memalign(alignment, size);
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
