// The result of a law suite: a list of violated laws. No test framework is needed; with one, check that the list is
// empty.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// One violated law: its name, where it was violated, the measured value and the bound.
struct Violation {
  std::string law;
  std::string detail;
  double value = 0.0;
  double bound = 0.0;
};

/// All violated laws of one subject; empty if all laws are satisfied.
using Violations = std::vector<Violation>;

/// Checks many values against one upper bound, and reports the worst of them and how many exceeded it.
class Worst {
 public:
  Worst(std::string law, double bound) : law_(std::move(law)), bound_(bound) {}

  /// `detail` is called for its text only if the value is the worst so far and above the bound. NaN counts as the worst
  /// value.
  template <class Detail>
  void observe(double value, Detail detail) {
    if (value <= bound_) return;
    ++count_;
    if (count_ > 1 && !(value > value_ || (std::isnan(value) && !std::isnan(value_)))) return;
    value_ = value;
    detail_ = detail();
  }
  void report(Violations& violations) const {
    if (count_ == 0) return;
    const std::string others = count_ == 1 ? std::string() : ", " + std::to_string(count_) + " in all";
    violations.push_back({law_, detail_ + others, value_, bound_});
  }

 private:
  std::string law_, detail_;
  double value_ = 0.0, bound_;
  std::int64_t count_ = 0;
};

/// Reports unless value <= bound. NaN is a violation.
inline void expect_at_most(Violations& v, std::string_view law, double value, double bound, std::string detail = {}) {
  if (!(value <= bound)) v.push_back({std::string(law), std::move(detail), value, bound});
}

/// Reports unless value >= bound. NaN is a violation.
inline void expect_at_least(Violations& v, std::string_view law, double value, double bound, std::string detail = {}) {
  if (!(value >= bound)) v.push_back({std::string(law), std::move(detail), value, bound});
}

/// Reports unless value > bound. NaN is a violation.
inline void expect_above(Violations& v, std::string_view law, double value, double bound, std::string detail = {}) {
  if (!(value > bound)) v.push_back({std::string(law), std::move(detail), value, bound});
}

/// Reports unless the condition is true.
inline void expect_true(Violations& v, std::string_view law, bool holds, std::string detail = {}) {
  if (!holds) v.push_back({std::string(law), std::move(detail), 0.0, 1.0});
}

/// Adds the violations of a part; `part` is prepended to their details.
inline void append(Violations& all, Violations more, const std::string& part = {}) {
  for (Violation& v : more) {
    if (!part.empty()) v.detail = v.detail.empty() ? part : part + ": " + v.detail;
    all.push_back(std::move(v));
  }
}

/// True if the law with that name is violated.
inline bool violates(const Violations& violations, std::string_view law) {
  for (const Violation& v : violations)
    if (v.law == law) return true;
  return false;
}

/// One line per violation; empty if there are none.
inline std::string describe(const Violations& violations) {
  std::string text;
  for (const Violation& v : violations) {
    text += v.law;
    if (!v.detail.empty()) text += " (" + v.detail + ")";
    text += ": " + number(v.value) + ", bound " + number(v.bound) + '\n';
  }
  return text;
}

}}}  // namespace palpate::testing
