// Rows for tools, and evenly spread points when there are fewer rows than points.
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/contact/detail/row_shares.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <algorithm>
#include <numeric>

using namespace palpate;

namespace {

using Counts = std::array<int, maximum_tools>;

/// A tick in which the tools press these numbers of points, in so far as they have rows; their densities are 0, 1/n,
/// 2/n ...
Counts tick(RowShares& shares, const Counts& points, int capacity) {
  std::array<double, maximum_tools> radius{};
  for (std::size_t t = 0; t < maximum_tools; ++t)
    if (points[t] > 0) radius[t] = 10.0;  // at least 1/64 of the points
  shares.begin_tick(radius, capacity, 1.0);
  shares.begin_round();
  Counts used{};
  for (std::size_t t = 0; t < maximum_tools; ++t)
    for (int i = 0; i < points[t]; ++i) {
      const int tool = static_cast<int>(t);
      if (!shares.keeps(tool, static_cast<double>(i) / points[t]))
        shares.note_skipped(tool, 1e-3);
      else if (used[t] == shares.share(tool))
        shares.note_left_out(tool, 2e-3);
      else
        ++used[t];
    }
  shares.end_tick(used);
  return used;
}

}  // namespace

TEST_CASE("rows are divided by need, and never more than there are", "[contact][row_shares]") {
  RowShares shares;
  const auto settle = [&](const Counts& points) {
    Counts used{};
    for (int i = 0; i < 400; ++i) used = tick(shares, points, 100);
    return used;
  };
  CHECK(settle({40}) == Counts{40});
  CHECK(shares.deepest() == 0.0);
  CHECK(settle({40, 30}) == Counts{40, 30});
  const Counts short_of_one = settle({10, 300});
  CHECK(short_of_one[0] == 10);  // needs less than half
  CHECK(short_of_one[1] >= 60);
  CHECK(short_of_one[1] <= 74);
  CHECK(shares.deepest() > 0.0);
  const Counts short_of_both = settle({300, 300});
  for (std::size_t t : {0u, 1u}) {
    CHECK(short_of_both[t] >= 40);
    CHECK(short_of_both[t] <= 50);
  }
  const Counts many = settle({300, 300, 300, 300, 300, 300, 300, 300});
  CHECK(*std::min_element(many.begin(), many.end()) >= 10);
  CHECK(std::accumulate(many.begin(), many.end(), 0) <= 100);
  CHECK(settle({40}) == Counts{40});
  CHECK(shares.deepest() == 0.0);
}

TEST_CASE("a contact that grows beyond its rows loses few points in a tick", "[contact][row_shares]") {
  RowShares shares;
  int before = 0;
  for (int points = 1; points < 400; ++points) {
    const int used = tick(shares, {points}, 64)[0];
    CHECK(std::abs(used - before) <= 5);
    if (points > 64) CHECK(used >= 50);
    before = used;
  }
}

TEST_CASE("contact points of low density are spread evenly over the surface", "[contact][row_shares]") {
  test::Pad pad = test::make_pad("z1", 1e4, {32, 32, 2});
  const ContactSurface& surface = pad.contact_surface();
  const ContactSamples samples(surface, 0.5e-3);
  REQUIRE(samples.count() > 3000);
  Vector3 low = surface.position(0);
  for (const Vector3& x : surface.positions()) low = low.cwiseMin(x);
  const double all = samples.count() / (0.03 * 0.03);
  for (const int parts : {4, 16, 64}) {
    std::vector<int> counts(16);
    int kept = 0;
    for (int s = 0; s < samples.count(); ++s) {
      CHECK(samples.density(s) >= 0.0);
      CHECK(samples.density(s) < samples.densest());
      if (!(samples.density(s) < all / parts)) continue;
      Vector3 x = Vector3::Zero();
      for (std::size_t a = 0; a < 3; ++a) x += samples[s].weights[a] * surface.position(samples[s].vertices[a]);
      ++kept;
      const auto quarter = [&](int i) { return std::clamp(static_cast<int>(4.0 * (x[i] - low[i]) / 0.03), 0, 3); };
      ++counts[static_cast<std::size_t>(4 * quarter(0) + quarter(1))];
    }
    const double expected = kept / 16.0;
    CHECK(kept == Catch::Approx(static_cast<double>(samples.count()) / parts).epsilon(0.25));
    for (const int n : counts) {
      CHECK(n > 0.6 * expected);
      CHECK(n < 1.5 * expected);
    }
  }
}
