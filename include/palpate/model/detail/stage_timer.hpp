// Measures the duration of a stage of set-up.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/model/cache/cache_report.hpp>
#include <palpate/model/setup_report.hpp>

#include <chrono>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

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

inline StageTimer::StageTimer(SetupReport& report, const char* stage)
    : report_(&report), line_(report.seconds.size()), start_(std::chrono::steady_clock::now()) {
  report.seconds.emplace_back(stage, 0.0);
}

inline StageTimer::~StageTimer() {
  report_->seconds[line_].second = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}}}  // namespace palpate::detail
