// How long a stage of set-up took.
#pragma once

#include <palpate/model/setup_report.hpp>

#include <chrono>

namespace palpate { inline namespace PALPATE_ABI {

/// Adds the time since its construction to a report when it goes. Its line in the report is made at once: a destructor
/// must not run out of memory.
class StageTimer {
 public:
  StageTimer(SetupReport& report, const char* stage)
      : report_(&report), line_(report.seconds.size()), start_(std::chrono::steady_clock::now()) {
    report.seconds.emplace_back(stage, 0.0);
  }
  ~StageTimer() {
    report_->seconds[line_].second = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  SetupReport* report_;
  std::size_t line_;
  std::chrono::steady_clock::time_point start_;
};

}}  // namespace palpate
