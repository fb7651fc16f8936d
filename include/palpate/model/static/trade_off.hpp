// Choice among measured compositions: the Pareto front, and the best composition within a budget.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Measurements of one composition of element, material and solver in one scene. All figures are finite and not
/// negative.
struct MeasuredComposition {
  std::string name;            ///< unique
  double latency = 0.0;        ///< of a tick, for example its p99 [s]
  double error = 0.0;          ///< relative to a reference [-]
  double setup_seconds = 0.0;  ///< [s]
  double bytes = 0.0;          ///< peak memory
};

/// Whether `a` is no worse than `b` in latency and error, and better in one.
inline bool dominates(const MeasuredComposition& a, const MeasuredComposition& b) noexcept {
  return a.latency <= b.latency && a.error <= b.error && (a.latency < b.latency || a.error < b.error);
}

/// Measured compositions of one scene, and the choice among them. Which one is chosen does not depend on the order in
/// which they were added.
class TradeOff {
 public:
  /// Throws non_finite for a figure that is NaN or infinite, bad_argument for one that is negative, for a name that is
  /// empty or already used. Strong guarantee. O(compositions).
  void add(MeasuredComposition measured);

  const std::vector<MeasuredComposition>& all() const noexcept { return all_; }
  /// nullptr when no composition has that name.
  const MeasuredComposition* find(const std::string& name) const noexcept {
    const auto it = std::ranges::find(all_, name, &MeasuredComposition::name);
    return it == all_.end() ? nullptr : &*it;
  }

  /// The Pareto front: all compositions that are not dominated, in order of rising latency and falling error; ties are
  /// all included. O(n log n).
  std::vector<MeasuredComposition> front() const;

  /// The smallest error with a latency of at most `seconds`; ties are resolved by lower latency, then less memory, then
  /// shorter set-up, then name. Empty when all are slower. Throws bad_argument for a budget that is NaN or negative;
  /// infinity is allowed. O(compositions).
  std::optional<MeasuredComposition> most_accurate_within(double seconds) const {
    require_budget(seconds);
    return best([=](const auto& m) { return m.latency <= seconds; },
                [](const auto& m) { return std::tie(m.error, m.latency, m.bytes, m.setup_seconds, m.name); });
  }
  /// The smallest latency with an error of at most `error`; ties are resolved by smaller error, then as above.
  std::optional<MeasuredComposition> fastest_within(double error) const {
    require_budget(error);
    return best([=](const auto& m) { return m.error <= error; },
                [](const auto& m) { return std::tie(m.latency, m.error, m.bytes, m.setup_seconds, m.name); });
  }

 private:
  static void require(const std::string& name, const char* what, double value);
  static void require_budget(double budget) {
    if (!(budget >= 0.0))
      raise(SetupErrorKind::bad_argument, "the budget is " + number(budget), "Give a number that is not negative");
  }
  template <class Allowed, class Order>
  std::optional<MeasuredComposition> best(Allowed allowed, Order order) const {
    const MeasuredComposition* found = nullptr;
    for (const MeasuredComposition& m : all_)
      if (allowed(m) && (found == nullptr || order(m) < order(*found))) found = &m;
    return found == nullptr ? std::nullopt : std::optional(*found);
  }

  std::vector<MeasuredComposition> all_;
};

inline void TradeOff::add(MeasuredComposition measured) {
  if (measured.name.empty()) raise(SetupErrorKind::bad_argument, "a measured composition has no name");
  if (find(measured.name) != nullptr)
    raise(SetupErrorKind::bad_argument, "'" + measured.name + "' was measured already", "Give every row its own name");
  require(measured.name, "latency", measured.latency);
  require(measured.name, "error", measured.error);
  require(measured.name, "set-up time", measured.setup_seconds);
  require(measured.name, "memory", measured.bytes);
  all_.push_back(std::move(measured));
}

inline std::vector<MeasuredComposition> TradeOff::front() const {
  std::vector<MeasuredComposition> sorted = all_, front;
  std::ranges::sort(sorted, {}, [](const MeasuredComposition& m) { return std::tie(m.latency, m.error, m.name); });
  for (MeasuredComposition& m : sorted)
    if (front.empty() || m.error < front.back().error ||
        (m.error == front.back().error && m.latency == front.back().latency))
      front.push_back(std::move(m));
  return front;
}

inline void TradeOff::require(const std::string& name, const char* what, double value) {
  if (std::isfinite(value) && value >= 0.0) return;
  SetupProblem p;
  p.kind = std::isfinite(value) ? SetupErrorKind::bad_argument : SetupErrorKind::non_finite;
  p.what = std::string("the ") + what + " of '" + name + "' is " + number(value);
  p.hint = "Leave out what could not be measured";
  p.value = value;
  raise(std::move(p));
}

}}  // namespace palpate
