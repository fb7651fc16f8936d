// The choice among measured compositions.
#include <palpate/model/static/trade_off.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"
#include "refused.hpp"

#include <algorithm>
#include <cmath>

using namespace palpate;

namespace {

/// Random compositions with many ties: figures are small integers.
std::vector<MeasuredComposition> random_compositions(testing::Random& random, int count) {
  const auto figure = [&] { return std::floor(random.uniform(0.0, 8.0)); };
  std::vector<MeasuredComposition> all;
  for (int i = 0; i < count; ++i) {
    MeasuredComposition m{.name = "row " + std::to_string(i)};
    m.latency = figure();
    m.error = figure();
    m.setup_seconds = figure();
    m.bytes = figure();
    all.push_back(m);
  }
  return all;
}
TradeOff trade_off_of(const std::vector<MeasuredComposition>& all) {
  TradeOff trade;
  for (const MeasuredComposition& m : all) trade.add(m);
  return trade;
}
std::vector<std::string> names_of(const std::vector<MeasuredComposition>& all) {
  std::vector<std::string> names;
  for (const MeasuredComposition& m : all) names.push_back(m.name);
  return names;
}
std::string name_of(const std::optional<MeasuredComposition>& m) {
  return m ? m->name : "nothing";
}
void shuffle(testing::Random& random, std::vector<MeasuredComposition>& all) {
  for (std::size_t i = all.size(); i > 1; --i)
    std::swap(all[i - 1], all[static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(i)))]);
}

}  // namespace

TEST_CASE("the front is the set of undominated compositions, in order", "[model][trade_off]") {
  testing::Random random(5);
  for (int round = 0; round < 200; ++round) {
    const auto all = random_compositions(random, 1 + round % 40);
    const auto front = trade_off_of(all).front();
    std::vector<std::string> undominated;
    for (const auto& m : all)
      if (std::ranges::none_of(all, [&](const auto& other) { return dominates(other, m); }))
        undominated.push_back(m.name);
    auto names = names_of(front);
    for (std::size_t i = 1; i < front.size(); ++i) {
      CHECK(front[i - 1].latency <= front[i].latency);
      CHECK(front[i - 1].error >= front[i].error);
    }
    std::ranges::sort(names);
    std::ranges::sort(undominated);
    REQUIRE(names == undominated);
  }
}

TEST_CASE("domination is a strict order", "[model][trade_off]") {
  testing::Random random(6);
  const auto all = random_compositions(random, 30);
  for (const auto& a : all) {
    CHECK_FALSE(dominates(a, a));
    for (const auto& b : all) {
      CHECK_FALSE((dominates(a, b) && dominates(b, a)));
      for (const auto& c : all)
        if (dominates(a, b) && dominates(b, c)) CHECK(dominates(a, c));
    }
  }
}

TEST_CASE("the choice does not depend on the order of adding", "[model][trade_off]") {
  testing::Random random(7);
  for (int round = 0; round < 100; ++round) {
    auto all = random_compositions(random, 25);
    const TradeOff first = trade_off_of(all);
    shuffle(random, all);
    const TradeOff second = trade_off_of(all);
    CHECK(names_of(first.front()) == names_of(second.front()));
    for (double budget = 0.0; budget < 9.0; budget += 0.5) {
      CHECK(name_of(first.most_accurate_within(budget)) == name_of(second.most_accurate_within(budget)));
      CHECK(name_of(first.fastest_within(budget)) == name_of(second.fastest_within(budget)));
    }
  }
}

TEST_CASE("the choice is within budget and on the front, and a larger budget never gives a worse choice",
          "[model][trade_off]") {
  testing::Random random(8);
  for (int round = 0; round < 100; ++round) {
    const TradeOff trade = trade_off_of(random_compositions(random, 12));
    const auto front = names_of(trade.front());
    double error = infinity, latency = infinity;
    for (double budget = 0.0; budget < 9.0; budget += 0.5) {
      const auto accurate = trade.most_accurate_within(budget), fast = trade.fastest_within(budget);
      const bool some = std::ranges::any_of(trade.all(), [&](const auto& m) { return m.latency <= budget; });
      REQUIRE(accurate.has_value() == some);
      if (accurate) {
        CHECK(accurate->latency <= budget);
        CHECK(accurate->error <= error);
        CHECK(std::ranges::count(front, accurate->name) == 1);
        error = accurate->error;
      }
      if (fast) {
        CHECK(fast->error <= budget);
        CHECK(fast->latency <= latency);
        CHECK(std::ranges::count(front, fast->name) == 1);
        latency = fast->latency;
      }
    }
    CHECK(trade.most_accurate_within(infinity)->error == trade.front().back().error);
    CHECK(trade.fastest_within(infinity)->latency == trade.front().front().latency);
  }
}

TEST_CASE("a dominated composition does not change the choice", "[model][trade_off]") {
  testing::Random random(9);
  for (int round = 0; round < 50; ++round) {
    const auto all = random_compositions(random, 10);
    TradeOff trade = trade_off_of(all);
    const auto before = names_of(trade.front());
    MeasuredComposition worse = all[static_cast<std::size_t>(round) % all.size()];
    worse.name = "worse";
    worse.latency += 0.25;
    trade.add(worse);
    CHECK(names_of(trade.front()) == before);
    for (double budget = 0.0; budget < 9.0; budget += 0.5) {
      CHECK(name_of(trade.most_accurate_within(budget)) != "worse");
      CHECK(name_of(trade.fastest_within(budget)) != "worse");
    }
  }
}

TEST_CASE("ties are resolved by memory, then set-up, then name", "[model][trade_off]") {
  TradeOff trade;
  trade.add({.name = "b", .latency = 1.0, .error = 1.0, .setup_seconds = 1.0, .bytes = 2.0});
  CHECK(name_of(trade.fastest_within(1.0)) == "b");
  trade.add({.name = "d", .latency = 1.0, .error = 1.0, .setup_seconds = 2.0, .bytes = 1.0});
  CHECK(name_of(trade.fastest_within(1.0)) == "d");
  trade.add({.name = "c", .latency = 1.0, .error = 1.0, .setup_seconds = 1.0, .bytes = 1.0});
  CHECK(name_of(trade.most_accurate_within(1.0)) == "c");
  trade.add({.name = "a", .latency = 1.0, .error = 1.0, .setup_seconds = 1.0, .bytes = 1.0});
  CHECK(name_of(trade.most_accurate_within(1.0)) == "a");
  CHECK(trade.front().size() == 4);
}

TEST_CASE("invalid figures are refused, and nothing is added", "[model][trade_off]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  TradeOff trade;
  trade.add({.name = "good", .latency = 1.0, .error = 1.0});
  for (const double bad : {nan, infinity, -infinity, -1.0}) {
    const SetupErrorKind kind = std::isfinite(bad) ? SetupErrorKind::bad_argument : SetupErrorKind::non_finite;
    CHECK_REFUSED(kind, trade.add({.name = "x", .latency = bad}));
    CHECK_REFUSED(kind, trade.add({.name = "x", .error = bad}));
    CHECK_REFUSED(kind, trade.add({.name = "x", .setup_seconds = bad}));
    CHECK_REFUSED(kind, trade.add({.name = "x", .bytes = bad}));
  }
  CHECK_REFUSED(SetupErrorKind::bad_argument, trade.add({.name = ""}));
  CHECK_REFUSED(SetupErrorKind::bad_argument, trade.add({.name = "good"}));
  CHECK(trade.all().size() == 1);
  for (const double bad : {nan, -1.0}) {
    CHECK_REFUSED(SetupErrorKind::bad_argument, trade.most_accurate_within(bad));
    CHECK_REFUSED(SetupErrorKind::bad_argument, trade.fastest_within(bad));
  }
  const auto problem = test::refusal([&] { trade.add({.name = "cg", .latency = nan}); });
  CHECK_THAT(problem.what, test::contains("latency of 'cg'"));
}

TEST_CASE("without measurements there is no choice", "[model][trade_off]") {
  const TradeOff none;
  CHECK(none.front().empty());
  CHECK_FALSE(none.most_accurate_within(infinity));
  CHECK_FALSE(none.fastest_within(infinity));
}
