// Definitions of stage_timer.hpp.
#pragma once

#include <palpate/model/detail/stage_timer.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE StageTimer::StageTimer(SetupReport& report, const char* stage)
    : report_(&report), line_(report.seconds.size()), start_(std::chrono::steady_clock::now()) {
  report.seconds.emplace_back(stage, 0.0);
}

PALPATE_INLINE StageTimer::~StageTimer() {
  report_->seconds[line_].second = std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

}}  // namespace palpate
