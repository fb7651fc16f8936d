// How long a stage of set-up took.
#pragma once

#include <palpate/model/setup_report.hpp>

#include <chrono>

namespace palpate::inline PALPATE_ABI {

/// Adds the time since its construction to a report when it goes.
class StageTimer {
 public:
  StageTimer(SetupReport& report, const char* stage)
      : report_(&report), stage_(stage), start_(std::chrono::steady_clock::now()) {}
  ~StageTimer() {
    report_->seconds.emplace_back(stage_,
                                  std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count());
  }
  StageTimer(const StageTimer&) = delete;
  StageTimer& operator=(const StageTimer&) = delete;

 private:
  SetupReport* report_;
  const char* stage_;
  std::chrono::steady_clock::time_point start_;
};

}  // namespace palpate::inline PALPATE_ABI
