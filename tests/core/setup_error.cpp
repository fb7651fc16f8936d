#include <cmath>
#include <limits>
#include <numeric>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <set>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("a problem stores the first sixteen ids and the total count", "[core][setup_error]") {
  SetupProblem p;
  std::vector<std::int64_t> ids(1000);
  std::iota(ids.begin(), ids.end(), 100);

  SECTION("many") {
    p.set_ids(ids);
    CHECK(SetupProblem::max_ids == 16);
    CHECK(p.ids.size() == 16);
    CHECK(p.ids.front() == 100);
    CHECK(p.ids.back() == 115);
    CHECK(p.count == 1000);
    CHECK_THAT(describe(p), test::contains("115 ... 1000 in all]"));
  }
  SECTION("exactly sixteen") {
    p.set_ids(std::span(ids).first(16));
    CHECK(p.ids.size() == 16);
    CHECK(p.count == 16);
    CHECK_THAT(describe(p), !test::contains("in all"));
  }
  SECTION("none") {
    p.set_ids(ids);
    p.set_ids({});
    CHECK(p.ids.empty());
    CHECK(p.count == 0);
    CHECK_THAT(describe(p), !test::contains("[ids"));
  }
}

TEST_CASE("a problem is described in one line", "[core][setup_error]") {
  SetupProblem p;
  p.kind = SetupErrorKind::inverted_element;
  p.what = "2 elements have negative volume";
  p.hint = "Swap two of their nodes";
  p.set_ids(std::vector<std::int64_t>{3, 17});
  CHECK(describe(p) == "inverted_element: 2 elements have negative volume [ids 3 17]. Swap two of their nodes");
  p.hint.clear();
  p.ids.clear();
  CHECK(describe(p) == "inverted_element: 2 elements have negative volume");
}

TEST_CASE("numbers in messages", "[core][setup_error]") {
  CHECK(number(0.5) == "0.5");
  CHECK(number(0.4999999) == "0.4999999");
  CHECK(number(-2.1e-9) == "-2.1e-09");
  CHECK(number(0.0) == "0");
  CHECK(number(1e308) == "1e+308");
  CHECK(number(-std::numeric_limits<double>::max()).size() < 40);
  CHECK(number(std::numeric_limits<double>::infinity()) == "inf");
  CHECK_THAT(number(std::numeric_limits<double>::quiet_NaN()), test::contains("nan"));
}

TEST_CASE("every kind has a unique name", "[core][setup_error]") {
  std::set<std::string_view> names;
  const int last = static_cast<int>(SetupErrorKind::unsupported);
  for (int k = 0; k <= last; ++k) names.insert(to_string(static_cast<SetupErrorKind>(k)));
  CHECK(names.size() == static_cast<std::size_t>(last + 1));
  CHECK(names.count("") == 0);
  CHECK(to_string(SetupErrorKind::bad_argument) == "bad_argument");
  CHECK(to_string(SetupErrorKind::poor_quality) == "poor_quality");
  CHECK(to_string(SetupErrorKind::unknown_group) == "unknown_group");
  CHECK(to_string(SetupErrorKind::unsupported) == "unsupported");
}

TEST_CASE("raise throws the problem it was given", "[core][setup_error]") {
  try {
    SetupProblem p;
    p.kind = SetupErrorKind::too_large;
    p.what = "it needs 9e+15 bytes";
    p.value = 9e15;
    p.threshold = 1e9;
    raise(p);
    FAIL("raise returned");
  } catch (const SetupError& error) {
    CHECK(error.kind() == SetupErrorKind::too_large);
    CHECK(error.problem().value == 9e15);
    CHECK(error.problem().threshold == 1e9);
    CHECK(std::string(error.what()) == "too_large: it needs 9e+15 bytes");
  }
  CHECK_THROWS_AS(raise(SetupErrorKind::bad_file, "line 3", "Mend it"), SetupError);
  CHECK_THROWS_WITH(raise(SetupErrorKind::bad_file, "line 3", "Mend it"), "bad_file: line 3. Mend it");
  CHECK_THROWS_AS(raise(SetupErrorKind::bad_file, ""), std::runtime_error);
}

TEST_CASE("a problem states what its ids refer to", "[core][setup_error]") {
  const auto text = [](SetupIds of, std::vector<std::int64_t> ids) {
    SetupProblem p;
    p.what = "so";
    p.set_ids(ids, of);
    return describe(p);
  };
  CHECK(text(SetupIds::others, {3}) == "bad_argument: so [ids 3]");
  CHECK(text(SetupIds::nodes, {3}) == "bad_argument: so [node 3]");
  CHECK(text(SetupIds::nodes, {3, 4}) == "bad_argument: so [nodes 3 4]");
  CHECK(text(SetupIds::elements, {3}) == "bad_argument: so [element 3]");
  CHECK(text(SetupIds::elements, {3, 4}) == "bad_argument: so [elements 3 4]");
}

namespace {

std::vector<std::int64_t> refused_ids(SetupIds of, std::vector<std::int64_t> ids) {
  try {
    SetupProblem p;
    p.set_ids(ids, of);
    raise(std::move(p));
  } catch (const SetupError& error) {
    return error.problem().ids;
  }
}

}  // namespace

TEST_CASE("ids of refusals are translated to the mesh as given", "[core][setup_error]") {
  using Ids = std::vector<std::int64_t>;
  const OriginalIds ids{{10, 11, 13}, {20, 22}}, plain;
  CHECK(refused_ids(SetupIds::nodes, {0, 2}) == Ids{0, 2});
  {
    const ScopedIdTranslation translation(ids);
    CHECK(refused_ids(SetupIds::nodes, {0, 2}) == Ids{10, 13});
    CHECK(refused_ids(SetupIds::elements, {0, 1}) == Ids{20, 22});
    CHECK(refused_ids(SetupIds::others, {0, 2}) == Ids{0, 2});
    CHECK(refused_ids(SetupIds::elements, {-1, 2}) == Ids{-1, 2});  // does not refer to an element: unchanged
    CHECK_THROWS_WITH(
        detail::raise_at(SetupIds::nodes, 2, SetupErrorKind::bad_density, "a node has no mass", "Give one"),
        "bad_density: a node has no mass [node 13]. Give one");
    {
      const ScopedIdTranslation inner(plain);
      CHECK(refused_ids(SetupIds::nodes, {0, 2}) == Ids{0, 2});
    }
    CHECK(refused_ids(SetupIds::nodes, {0, 2}) == Ids{10, 13});
    Ids inside;
    SetupLimits limits;
    limits.progress = [&](const Progress&) {
      inside = refused_ids(SetupIds::nodes, {0, 2});
      return true;
    };
    limits.advance("checks", 0.0);
    CHECK(inside == Ids{0, 2});  // ids of a refusal in a callback do not belong to this mesh
  }
  CHECK(refused_ids(SetupIds::nodes, {0, 2}) == Ids{0, 2});
}
