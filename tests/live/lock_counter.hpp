// Counts the mutexes that a thread locks, to verify that a tick locks none.
#pragma once

#include <cstdint>
#include <cstdlib>  // __GLIBC__

namespace test {

#ifdef __GLIBC__
inline constexpr bool locks_are_counted = true;
#else
inline constexpr bool locks_are_counted = false;
#endif

/// Of this thread since it started; also of a lock that is only tried.
std::uint64_t locks_of_thread() noexcept;

}  // namespace test
