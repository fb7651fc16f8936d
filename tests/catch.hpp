#pragma once

/// One include for Catch2 v2.13 and v3. Compare numbers with Catch::Matchers::WithinAbs / WithinRel or Catch::Approx,
/// always with `Catch::`, as only v2 puts Approx into the global namespace too; texts with test::contains.
#if __has_include(<catch2/catch_test_macros.hpp>)
#include <catch2/catch_approx.hpp>
#include <catch2/catch_template_test_macros.hpp>
#include <catch2/catch_test_macros.hpp>
#include <catch2/generators/catch_generators_all.hpp>
#include <catch2/matchers/catch_matchers_all.hpp>
#else
#include <catch2/catch.hpp>
namespace Catch {
using Detail::Approx;  // as in v3
}
#endif

#include <string>

namespace test {

/// Matcher: the text contains `part`.
inline auto contains(const std::string& part) {
#if __has_include(<catch2/catch_test_macros.hpp>)
  return Catch::Matchers::ContainsSubstring(part);
#else
  return Catch::Matchers::Contains(part);
#endif
}

}  // namespace test
