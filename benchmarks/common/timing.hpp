// Processor time, medians of it, and memory use of a function.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#if defined(__GLIBC__)
#include <malloc.h>
#endif

namespace bench {

inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

/// Processor time of the whole process [s]: all threads count, so a baseline that uses a second thread has no
/// advantage.
inline double process_seconds() noexcept {
#if defined(CLOCK_PROCESS_CPUTIME_ID)
  timespec t{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
#else
  return static_cast<double>(std::clock()) / CLOCKS_PER_SEC;
#endif
}

template <class Work>
double seconds_of(Work&& work) {
  const double start = process_seconds();
  work();
  return process_seconds() - start;
}

/// The value that a share `fraction` of all values does not exceed; NaN when empty.
inline double percentile(std::vector<double> values, double fraction) {
  if (values.empty()) return unknown;
  const auto at = static_cast<std::ptrdiff_t>(fraction * static_cast<double>(values.size() - 1));
  std::nth_element(values.begin(), values.begin() + at, values.end());
  return values[static_cast<std::size_t>(at)];
}

/// Number of repetitions: until `seconds` are spent, but at least `least` and at most `most`.
struct Repeat {
  double seconds = 1.5;
  int least = 3, most = 15;
};

/// Median processor time of work() [s]. Work shorter than a millisecond is timed in batches of eight.
template <class Work>
double median_seconds(Work&& work, Repeat repeat = {}) {
  const double first = seconds_of(work);
  const int batch = first < 1e-3 ? 8 : 1;
  std::vector<double> times;
  double spent = first;
  for (int i = 0; i < repeat.least || (i < repeat.most && spent < repeat.seconds); ++i) {
    times.push_back(seconds_of([&] {
                      for (int k = 0; k < batch; ++k) work();
                    }) /
                    batch);
    spent += batch * times.back();
  }
  return percentile(std::move(times), 0.5);
}

/// Median times [s] of two functions called alternately, so that a slow phase of the machine affects both.
template <class First, class Second>
std::pair<double, double> medians_in_turns(First&& first, Second&& second, Repeat repeat = {}) {
  std::vector<double> one, other;
  double spent = 0.0;
  for (int i = 0; i < repeat.least || (i < repeat.most && spent < repeat.seconds); ++i) {
    one.push_back(seconds_of(first));
    other.push_back(seconds_of(second));
    spent += one.back() + other.back();
  }
  return {percentile(std::move(one), 0.5), percentile(std::move(other), 0.5)};
}

/// Value of a line of /proc/self/status [bytes]; NaN when it does not exist.
inline double process_bytes(const char* key) {
  std::ifstream status("/proc/self/status");
  for (std::string line; std::getline(status, line);)
    if (line.rfind(key, 0) == 0) return 1024.0 * std::atof(line.c_str() + std::strlen(key) + 1);
  return unknown;
}

#if defined(__GLIBC__)
/// Settings of the allocator as it makes them by itself once blocks of 32 MB were freed; smaller ones are then used
/// again, without page faults. Any setting switches this adaptation off, see mallopt(3).
inline void reset_allocator() noexcept {
  constexpr int most_maps = 65536, largest_kept = 32 << 20;
  mallopt(M_MMAP_MAX, most_maps);
  mallopt(M_MMAP_THRESHOLD, largest_kept);
  mallopt(M_TRIM_THRESHOLD, 2 * largest_kept);
  malloc_trim(0);
}
#endif

/// While it exists, freed memory stays in the process (glibc): on virtual machines the system may take as long to
/// provide the pages of a factor as the factorisation.
class KeepFreedMemory {
 public:
#if defined(__GLIBC__)
  KeepFreedMemory() {
    mallopt(M_MMAP_MAX, 0);
    mallopt(M_TRIM_THRESHOLD, std::numeric_limits<int>::max());
  }
  ~KeepFreedMemory() {
    reset_allocator();
  }
#else
  KeepFreedMemory() = default;
#endif
  KeepFreedMemory(const KeepFreedMemory&) = delete;
  KeepFreedMemory& operator=(const KeepFreedMemory&) = delete;
};

/// Largest growth of the resident memory during work() [bytes]; NaN where the system does not report it. Large blocks
/// are returned to the system when they are freed (glibc): what the allocator would keep is not counted.
template <class Work>
double peak_growth(Work&& work) {
#if defined(__GLIBC__)
  constexpr int large = 128 * 1024;
  mallopt(M_MMAP_THRESHOLD, large);
  mallopt(M_TRIM_THRESHOLD, large);
  malloc_trim(0);
#endif
  std::ofstream("/proc/self/clear_refs") << "5";  // resets the recorded peak
  const double before = process_bytes("VmRSS");
  work();
  const double growth = process_bytes("VmHWM") - before;
#if defined(__GLIBC__)
  reset_allocator();
#endif
  return growth;
}

}  // namespace bench
