// Choice among measured compositions: the Pareto front, and the best composition within a budget.
#pragma once

#include <palpate/core/config.hpp>

#include <optional>
#include <string>
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
bool dominates(const MeasuredComposition& a, const MeasuredComposition& b) noexcept;

/// Measured compositions of one scene, and the choice among them. Which one is chosen does not depend on the order in
/// which they were added.
class TradeOff {
 public:
  /// Throws non_finite for a figure that is NaN or infinite, bad_argument for one that is negative, for a name that is
  /// empty or already used. Strong guarantee. O(compositions).
  void add(MeasuredComposition measured);

  const std::vector<MeasuredComposition>& all() const noexcept { return all_; }
  /// nullptr when no composition has that name.
  const MeasuredComposition* find(const std::string& name) const noexcept;

  /// The Pareto front: all compositions that are not dominated, in order of rising latency and falling error; ties are
  /// all included. O(n log n).
  std::vector<MeasuredComposition> front() const;

  /// The smallest error with a latency of at most `seconds`; ties are resolved by lower latency, then less memory, then
  /// shorter set-up, then name. Empty when all are slower. Throws bad_argument for a budget that is NaN or negative;
  /// infinity is allowed. O(compositions).
  std::optional<MeasuredComposition> most_accurate_within(double seconds) const;
  /// The smallest latency with an error of at most `error`; ties are resolved by smaller error, then as above.
  std::optional<MeasuredComposition> fastest_within(double error) const;

 private:
  static void require(const std::string& name, const char* what, double value);
  static void require_budget(double budget);
  template <class Allowed, class Order>
  std::optional<MeasuredComposition> best(Allowed allowed, Order order) const {
    const MeasuredComposition* found = nullptr;
    for (const MeasuredComposition& m : all_)
      if (allowed(m) && (found == nullptr || order(m) < order(*found))) found = &m;
    return found == nullptr ? std::nullopt : std::optional(*found);
  }

  std::vector<MeasuredComposition> all_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/trade_off.ipp>
#endif
