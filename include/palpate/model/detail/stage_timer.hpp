// Measures the duration of a stage of set-up.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/model/cache/cache_report.hpp>
#include <palpate/model/setup_report.hpp>

#include <chrono>

namespace palpate { inline namespace PALPATE_ABI {

/// Its destructor writes the time since construction [s] to a report. The constructor allocates the line in the report,
/// because a destructor must not run out of memory.
class StageTimer {
 public:
  StageTimer(SetupReport& report, const char* stage);
  ~StageTimer();
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  SetupReport* report_;
  std::size_t line_;
  std::chrono::steady_clock::time_point start_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/stage_timer.ipp>
#endif
