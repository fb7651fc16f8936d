// Definitions of trade_off.hpp.
#pragma once

#include <palpate/model/static/trade_off.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE bool dominates(const MeasuredComposition& a, const MeasuredComposition& b) noexcept {
  return a.latency <= b.latency && a.error <= b.error && (a.latency < b.latency || a.error < b.error);
}

PALPATE_INLINE void TradeOff::add(MeasuredComposition measured) {
  if (measured.name.empty()) raise(SetupErrorKind::bad_argument, "a measured composition has no name");
  if (find(measured.name) != nullptr)
    raise(SetupErrorKind::bad_argument, "'" + measured.name + "' was measured already", "Give every row its own name");
  require(measured.name, "latency", measured.latency);
  require(measured.name, "error", measured.error);
  require(measured.name, "set-up time", measured.setup_seconds);
  require(measured.name, "memory", measured.bytes);
  all_.push_back(std::move(measured));
}

PALPATE_INLINE const MeasuredComposition* TradeOff::find(const std::string& name) const noexcept {
  const auto it = std::ranges::find(all_, name, &MeasuredComposition::name);
  return it == all_.end() ? nullptr : &*it;
}

PALPATE_INLINE std::vector<MeasuredComposition> TradeOff::front() const {
  std::vector<MeasuredComposition> sorted = all_, front;
  std::ranges::sort(sorted, {}, [](const MeasuredComposition& m) { return std::tie(m.latency, m.error, m.name); });
  for (MeasuredComposition& m : sorted)
    if (front.empty() || m.error < front.back().error ||
        (m.error == front.back().error && m.latency == front.back().latency))
      front.push_back(std::move(m));
  return front;
}

PALPATE_INLINE std::optional<MeasuredComposition> TradeOff::most_accurate_within(double seconds) const {
  require_budget(seconds);
  return best([=](const auto& m) { return m.latency <= seconds; },
              [](const auto& m) { return std::tie(m.error, m.latency, m.bytes, m.setup_seconds, m.name); });
}

PALPATE_INLINE std::optional<MeasuredComposition> TradeOff::fastest_within(double error) const {
  require_budget(error);
  return best([=](const auto& m) { return m.error <= error; },
              [](const auto& m) { return std::tie(m.latency, m.error, m.bytes, m.setup_seconds, m.name); });
}

PALPATE_INLINE void TradeOff::require(const std::string& name, const char* what, double value) {
  if (std::isfinite(value) && value >= 0.0) return;
  SetupProblem p;
  p.kind = std::isfinite(value) ? SetupErrorKind::bad_argument : SetupErrorKind::non_finite;
  p.what = std::string("the ") + what + " of '" + name + "' is " + number(value);
  p.hint = "Leave out what could not be measured";
  p.value = value;
  raise(std::move(p));
}

PALPATE_INLINE void TradeOff::require_budget(double budget) {
  if (!(budget >= 0.0))
    raise(SetupErrorKind::bad_argument, "the budget is " + number(budget), "Give a number that is not negative");
}

}}  // namespace palpate
