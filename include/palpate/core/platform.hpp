// All code that depends on the operating system or the processor. No other header checks which one it is. And the
// processor setting of the tick: denormals are flushed to zero inside a scope.
#pragma once

#include <palpate/core/config.hpp>

#include <cerrno>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <string>
#include <system_error>
#include <thread>

#if defined(__linux__)
#include <pthread.h>
#include <sched.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <time.h>
#elif defined(_WIN32)
#include <fcntl.h>
#include <io.h>
#include <share.h>
#include <sys/stat.h>

// <windows.h> defines macros named min, max, near, far and small in every program that includes it. The functions
// needed are declared here instead, with the types of <windows.h>, so that it may be included before or after.
struct _SECURITY_ATTRIBUTES;
union _LARGE_INTEGER;
extern "C" {
__declspec(dllimport) void* __stdcall CreateWaitableTimerExW(_SECURITY_ATTRIBUTES*, const wchar_t*, unsigned long,
                                                             unsigned long);
__declspec(dllimport) int __stdcall SetWaitableTimer(void*, const _LARGE_INTEGER*, long,
                                                     void(__stdcall*)(void*, unsigned long, unsigned long), void*, int);
__declspec(dllimport) unsigned long __stdcall WaitForSingleObject(void*, unsigned long);
__declspec(dllimport) int __stdcall CloseHandle(void*);
__declspec(dllimport) void* __stdcall GetCurrentThread();
__declspec(dllimport) int __stdcall SetThreadPriority(void*, int);
__declspec(dllimport) unsigned long __stdcall GetLastError();
#if defined(_WIN64)
__declspec(dllimport) unsigned long long __stdcall SetThreadAffinityMask(void*, unsigned long long);
#else
__declspec(dllimport) unsigned long __stdcall SetThreadAffinityMask(void*, unsigned long);
#endif
}
#endif

#if defined(__SSE2__) || defined(_M_X64)
#include <immintrin.h>
#define PALPATE_HAS_MXCSR 1
#endif

/// A function that the system does not support does nothing and returns not_supported. Errors are the system's error
/// codes, 0 for success.
namespace palpate { inline namespace PALPATE_ABI { namespace platform {

inline constexpr int not_supported = -1;

/// The system's message for an error code of this header's functions.
inline std::string error_text(int error) {
  return error == not_supported ? std::string("not supported on this system") : std::system_category().message(error);
}

#if defined(__linux__)

namespace detail {
inline std::int64_t clock_ns(clockid_t clock) noexcept {
  timespec t{};
  clock_gettime(clock, &t);
  return std::int64_t{t.tv_sec} * 1'000'000'000 + t.tv_nsec;
}
}  // namespace detail

/// Steady time [ns].
inline std::int64_t wall_ns() noexcept {
  return detail::clock_ns(CLOCK_MONOTONIC);
}
/// Processor time of this thread [ns]: does not include time used by other programs on a busy machine. A system call:
/// 0.2 to 1 us. On systems without such a fine clock: steady time.
inline std::int64_t compute_ns() noexcept {
  return detail::clock_ns(CLOCK_THREAD_CPUTIME_ID);
}
/// Sleeps until steady time `deadline` [ns].
inline void sleep_until_ns(std::int64_t deadline) noexcept {
  const timespec t{static_cast<time_t>(deadline / 1'000'000'000), static_cast<long>(deadline % 1'000'000'000)};
  while (clock_nanosleep(CLOCK_MONOTONIC, TIMER_ABSTIME, &t, nullptr) == EINTR) {}
}
/// This thread's sleeps are not rounded up by the default 50 us.
inline void ask_for_exact_sleeps() noexcept {
  prctl(PR_SET_TIMERSLACK, 1UL, 0UL, 0UL, 0UL);
}

inline int pin_this_thread(int cpu) noexcept {
  cpu_set_t set;
  CPU_ZERO(&set);
  if (cpu < CPU_SETSIZE) CPU_SET(static_cast<std::size_t>(cpu), &set);
  return pthread_setaffinity_np(pthread_self(), sizeof set, &set);
}
/// The scheduling that ask_for_realtime_scheduling requests.
inline constexpr const char* realtime_scheduling = "SCHED_FIFO 50";
inline int ask_for_realtime_scheduling() noexcept {
  sched_param priority{};
  priority.sched_priority = 50;
  return pthread_setschedparam(pthread_self(), SCHED_FIFO, &priority);
}
/// Locks the currently mapped pages in memory. Does not use MCL_FUTURE: with a small limit on locked memory, it would
/// make later allocations anywhere in the program fail.
inline int lock_memory() noexcept {
  return mlockall(MCL_CURRENT) == 0 ? 0 : errno;
}

/// Requests huge pages, for fewer page faults; only a hint.
inline void prefer_huge_pages([[maybe_unused]] void* memory, [[maybe_unused]] std::size_t bytes) noexcept {
#if defined(MADV_HUGEPAGE)
  ::madvise(memory, bytes, MADV_HUGEPAGE);
#endif
}

#else

inline std::int64_t wall_ns() noexcept {
  return std::chrono::nanoseconds(std::chrono::steady_clock::now().time_since_epoch()).count();
}
inline std::int64_t compute_ns() noexcept {
  return wall_ns();
}
inline int lock_memory() noexcept {
  return not_supported;
}
inline void prefer_huge_pages(void*, std::size_t) noexcept {}
inline void ask_for_exact_sleeps() noexcept {}

#if defined(_WIN32)

namespace detail {
/// Sleep on Windows wakes up only at ticks of the system timer, every 15.6 ms. A high-resolution timer (Windows 10 from
/// 1803 on) keeps a period of 1 ms.
class WaitableTimer {
 public:
  WaitableTimer() noexcept {
    constexpr unsigned long manual_reset = 1, high_resolution = 2, all_access = 0x1F0003;
    handle_ = CreateWaitableTimerExW(nullptr, nullptr, manual_reset | high_resolution, all_access);
    if (handle_ == nullptr) handle_ = CreateWaitableTimerExW(nullptr, nullptr, manual_reset, all_access);
  }
  ~WaitableTimer() {
    if (handle_ != nullptr) CloseHandle(handle_);
  }
  WaitableTimer(const WaitableTimer&) = delete;
  WaitableTimer& operator=(const WaitableTimer&) = delete;

  /// False if there is no timer.
  bool wait(std::int64_t ns) const noexcept {
    const std::int64_t hundreds = -(ns + 99) / 100;  // negative: from now
    if (handle_ == nullptr) return false;
    const auto* due = reinterpret_cast<const _LARGE_INTEGER*>(&hundreds);
    constexpr unsigned long for_ever = 0xFFFFFFFF;
    return SetWaitableTimer(handle_, due, 0, nullptr, nullptr, 0) != 0 && WaitForSingleObject(handle_, for_ever) == 0;
  }

 private:
  void* handle_ = nullptr;
};
}  // namespace detail

inline void sleep_until_ns(std::int64_t deadline) noexcept {
  static thread_local const detail::WaitableTimer timer;
  for (std::int64_t left = deadline - wall_ns(); left > 0; left = deadline - wall_ns())
    if (!timer.wait(left)) std::this_thread::sleep_for(std::chrono::nanoseconds(left));
}
inline int pin_this_thread(int cpu) noexcept {
  using Mask = decltype(SetThreadAffinityMask(nullptr, 0));
  constexpr int invalid_parameter = 87;
  if (cpu < 0 || cpu >= static_cast<int>(8 * sizeof(Mask))) return invalid_parameter;
  return SetThreadAffinityMask(GetCurrentThread(), Mask{1} << cpu) != 0 ? 0 : static_cast<int>(GetLastError());
}
inline constexpr const char* realtime_scheduling = "time-critical priority";
inline int ask_for_realtime_scheduling() noexcept {
  constexpr int time_critical = 15;
  return SetThreadPriority(GetCurrentThread(), time_critical) != 0 ? 0 : static_cast<int>(GetLastError());
}

#else

inline void sleep_until_ns(std::int64_t deadline) noexcept {
  using Clock = std::chrono::steady_clock;
  const std::chrono::nanoseconds since_epoch(deadline);
  std::this_thread::sleep_until(Clock::time_point(std::chrono::duration_cast<Clock::duration>(since_epoch)));
}
inline int pin_this_thread(int) noexcept {
  return not_supported;
}
inline constexpr const char* realtime_scheduling = "real-time scheduling";
inline int ask_for_realtime_scheduling() noexcept {
  return not_supported;
}

#endif
#endif

/// Opens a new file for writing; the file must not exist yet. On failure returns null and sets errno.
inline std::FILE* create_new_file(const std::string& path) noexcept {
#if defined(_WIN32)
  // Older C libraries of Windows do not support fopen's "x".
  int file = -1;
  if (_sopen_s(&file, path.c_str(), _O_CREAT | _O_EXCL | _O_WRONLY | _O_BINARY, _SH_DENYNO, _S_IREAD | _S_IWRITE) != 0)
    return nullptr;
  std::FILE* const stream = _fdopen(file, "wb");
  if (stream == nullptr) _close(file);
  return stream;
#else
  return std::fopen(path.c_str(), "wbx");
#endif
}

/// The processor's control register for denormals, and the bits that flush denormals to zero; 0 on unsupported
/// processors.
#if defined(PALPATE_HAS_MXCSR)
inline std::uint64_t float_mode() noexcept {
  return _mm_getcsr();
}
inline void set_float_mode(std::uint64_t mode) noexcept {
  _mm_setcsr(static_cast<unsigned>(mode));
}
inline constexpr std::uint64_t flush_denormals = 0x8040;  // FTZ and DAZ
/// Informs the processor that this thread spins.
inline void pause() noexcept {
  _mm_pause();
}
#elif defined(__aarch64__) && !defined(_MSC_VER)
inline std::uint64_t float_mode() noexcept {
  std::uint64_t mode = 0;
  asm volatile("mrs %0, fpcr" : "=r"(mode));
  return mode;
}
inline void set_float_mode(std::uint64_t mode) noexcept {
  asm volatile("msr fpcr, %0" : : "r"(mode));
}
inline constexpr std::uint64_t flush_denormals = std::uint64_t{1} << 24;
inline void pause() noexcept {
  asm volatile("yield");
}
#else
inline std::uint64_t float_mode() noexcept {
  return 0;
}
inline void set_float_mode(std::uint64_t) noexcept {}
inline constexpr std::uint64_t flush_denormals = 0;
inline void pause() noexcept {}
#endif

}}}  // namespace palpate::platform

namespace palpate { inline namespace PALPATE_ABI {

/// Flushes denormals to zero (FTZ and DAZ) during its lifetime and restores the thread's mode afterwards. The state of
/// a body that comes to rest decays into denormals, with which a multiplication takes 20 to 130 times longer. Does
/// nothing on unsupported processors.
class FlushDenormals {
 public:
  FlushDenormals() noexcept : saved_(platform::float_mode()) {
    platform::set_float_mode(saved_ | platform::flush_denormals);
  }
  ~FlushDenormals() { platform::set_float_mode(saved_); }
  FlushDenormals(const FlushDenormals&) = delete;
  FlushDenormals& operator=(const FlushDenormals&) = delete;

 private:
  std::uint64_t saved_;
};

}}  // namespace palpate
