// Definitions of violation.hpp.
#pragma once

#include <palpate/testing/violation.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

PALPATE_INLINE void expect_at_most(Violations& v, std::string_view law, double value, double bound,
                                   std::string detail) {
  if (!(value <= bound)) v.push_back({std::string(law), std::move(detail), value, bound});
}

PALPATE_INLINE void expect_at_least(Violations& v, std::string_view law, double value, double bound,
                                    std::string detail) {
  if (!(value >= bound)) v.push_back({std::string(law), std::move(detail), value, bound});
}

PALPATE_INLINE void expect_above(Violations& v, std::string_view law, double value, double bound, std::string detail) {
  if (!(value > bound)) v.push_back({std::string(law), std::move(detail), value, bound});
}

PALPATE_INLINE void expect_true(Violations& v, std::string_view law, bool holds, std::string detail) {
  if (!holds) v.push_back({std::string(law), std::move(detail), 0.0, 1.0});
}

PALPATE_INLINE void append(Violations& all, Violations more, const std::string& part) {
  for (Violation& v : more) {
    if (!part.empty()) v.detail = v.detail.empty() ? part : part + ": " + v.detail;
    all.push_back(std::move(v));
  }
}

PALPATE_INLINE bool violates(const Violations& violations, std::string_view law) {
  for (const Violation& v : violations)
    if (v.law == law) return true;
  return false;
}

PALPATE_INLINE std::string describe(const Violations& violations) {
  std::string text;
  for (const Violation& v : violations) {
    text += v.law;
    if (!v.detail.empty()) text += " (" + v.detail + ")";
    text += ": " + number(v.value) + ", bound " + number(v.bound) + '\n';
  }
  return text;
}

PALPATE_INLINE void Worst::report(Violations& violations) const {
  if (count_ == 0) return;
  const std::string others = count_ == 1 ? std::string() : ", " + std::to_string(count_) + " in all";
  violations.push_back({law_, detail_ + others, value_, bound_});
}

}}}  // namespace palpate::testing
