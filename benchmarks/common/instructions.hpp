// Instructions that this thread executes, from the counters of the processor.
#pragma once

#include <cstdint>

#if defined(__linux__)
#include <linux/perf_event.h>
#include <sys/ioctl.h>
#include <sys/syscall.h>
#include <unistd.h>
#endif

namespace bench {

/// Counts instructions of the calling thread in user mode while it is running. Without counters (another system, or no
/// permission) `count` is zero.
class InstructionCounter {
 public:
#if defined(__linux__)
  InstructionCounter() {
    perf_event_attr attributes{};
    attributes.type = PERF_TYPE_HARDWARE;
    attributes.size = sizeof attributes;
    attributes.config = PERF_COUNT_HW_INSTRUCTIONS;
    attributes.disabled = 1;
    attributes.exclude_kernel = 1;
    attributes.exclude_hv = 1;
    file_ = static_cast<int>(syscall(SYS_perf_event_open, &attributes, 0, -1, -1, 0));
  }
  ~InstructionCounter() {
    if (file_ >= 0) close(file_);
  }
  void start() const noexcept {
    if (file_ < 0) return;
    ioctl(file_, PERF_EVENT_IOC_RESET, 0);
    ioctl(file_, PERF_EVENT_IOC_ENABLE, 0);
  }
  std::uint64_t stop() const noexcept {
    std::uint64_t count = 0;
    if (file_ < 0) return 0;
    ioctl(file_, PERF_EVENT_IOC_DISABLE, 0);
    return read(file_, &count, sizeof count) == static_cast<ssize_t>(sizeof count) ? count : 0;
  }
#else
  InstructionCounter() = default;
  void start() const noexcept {}
  std::uint64_t stop() const noexcept {
    return 0;
  }
#endif
  InstructionCounter(const InstructionCounter&) = delete;
  InstructionCounter& operator=(const InstructionCounter&) = delete;

 private:
  int file_ = -1;
};

}  // namespace bench
