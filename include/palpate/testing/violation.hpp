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

/// Reports unless value <= bound. NaN is a violation.
void expect_at_most(Violations& v, std::string_view law, double value, double bound, std::string detail = {});

/// Reports unless value >= bound. NaN is a violation.
void expect_at_least(Violations& v, std::string_view law, double value, double bound, std::string detail = {});

/// Reports unless value > bound. NaN is a violation.
void expect_above(Violations& v, std::string_view law, double value, double bound, std::string detail = {});

/// Reports unless the condition is true.
void expect_true(Violations& v, std::string_view law, bool holds, std::string detail = {});

/// Adds the violations of a part; `part` is prepended to their details.
void append(Violations& all, Violations more, const std::string& part = {});

/// True if the law with that name is violated.
bool violates(const Violations& violations, std::string_view law);

/// One line per violation; empty if there are none.
std::string describe(const Violations& violations);

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
  void report(Violations& violations) const;

 private:
  std::string law_, detail_;
  double value_ = 0.0, bound_;
  std::int64_t count_ = 0;
};

}}}  // namespace palpate::testing

#if PALPATE_HEADER_ONLY
#include <palpate/testing/violation.ipp>
#endif
