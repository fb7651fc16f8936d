// Rows for tools, and the level of their contact points.
#include <palpate/contact/detail/point_levels.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

using namespace palpate;

namespace {

using Counts = std::array<int, maximum_tools>;
using Areas = std::array<double, maximum_tools>;
constexpr double tip_radius = 4e-3;

detail::ContactSamples plane_of_samples() {
  test::Pad pad = test::make_pad("z1", 1e4, {16, 16, 2});
  return {pad.contact_surface(), detail::PointLevels::finest_spacing * tip_radius,
          detail::PointLevels::crowded_spacing * tip_radius};
}

/// A tick in which tools press parts of a plane with these areas, in so far as they have rows. `density`: of the
/// points, relative to that of hexagons. `spread`: points of equal area per point that presses.
Counts tick(detail::PointLevels& levels, const detail::ContactSamples& samples, const Areas& areas, int capacity,
            double density = 1.0, const Areas& vertices = {}, double spread = 1.0) {
  std::array<detail::PointLevels::Size, maximum_tools> sizes;
  sizes.fill({tip_radius, tip_radius});
  std::array<bool, maximum_tools> near{};
  for (std::size_t t = 0; t < maximum_tools; ++t) near[t] = areas[t] > 0.0;
  levels.begin_tick(samples, sizes, near, {capacity, 24});
  Counts used{};
  std::array<double, maximum_tools> pressing{};
  for (std::size_t t = 0; t < maximum_tools; ++t) {
    const int tool = static_cast<int>(t);
    const auto points_at = [&](double level) {
      return density * areas[t] / (0.866 * std::pow(samples.spacing(level), 2));
    };
    // Between two levels there are the points of the lower one.
    const int points = static_cast<int>(points_at(std::floor(levels.level(tool))));
    used[t] = std::min(points, levels.share(tool));
    for (int i = used[t]; i < points; ++i) levels.note_left_out(tool, 1e-3);
    pressing[t] = spread * points_at(levels.level(tool)) * used[t] / std::max(1, points);
  }
  levels.end_tick(used, pressing, {}, vertices);
  return used;
}

}  // namespace

TEST_CASE("a press has about the wanted number of points at any size of its area", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  const double finest = std::floor(samples.level_with(detail::PointLevels::finest_spacing * tip_radius));
  detail::PointLevels levels;
  for (double area = 1e-6; area < 3e-5; area *= 1.05) {
    Counts used{};
    for (int i = 0; i < 200; ++i) used = tick(levels, samples, {area}, 64);
    if (levels.level(0) <= finest) continue;  // first touch: fewer
    CHECK(levels.level(0) == std::floor(levels.level(0)));
    CHECK(used[0] >= 15);
    CHECK(used[0] <= 44);
    CHECK(levels.deepest() == 0.0);
  }
  tick(levels, samples, {0.0}, 64);
  CHECK(levels.level(0) == finest);
}

TEST_CASE("at large strain a press has about as many points as vertices, as far as there are rows",
          "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  const auto points = [&](double vertices, int capacity) {
    detail::PointLevels levels;
    Counts used{};
    for (int i = 0; i < 400; ++i) used = tick(levels, samples, {6e-5}, capacity, 1.0, {vertices});
    return used[0];
  };
  CHECK(points(4.0, 128) == points(0.0, 128));
  CHECK(points(0.0, 128) <= 24 * 1.6);
  CHECK(points(60.0, 128) >= 0.7 * 60);
  CHECK(points(60.0, 128) <= 128);
  CHECK(points(1000.0, 128) <= 128);
  CHECK(points(1000.0, 64) <= 64);
}

TEST_CASE("levels change in small steps", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  detail::PointLevels levels;
  double before = 0.0;
  for (int i = 0; i < 400; ++i) {
    tick(levels, samples, {i < 200 ? 2e-5 : 4e-6}, 400);
    if (i > 0) CHECK(std::abs(levels.level(0) - before) <= 0.1 + 1e-12);
    before = levels.level(0);
  }
}

TEST_CASE("a print that changes by a tenth and back keeps its level", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  for (double area = 4e-6; area < 3e-5; area *= 1.1) {
    detail::PointLevels levels;
    for (int i = 0; i < 200; ++i) tick(levels, samples, {i % 100 < 50 ? area : 1.1 * area}, 400);
    const double level = levels.level(0);
    for (int i = 0; i < 200; ++i) {
      tick(levels, samples, {i % 100 < 50 ? area : 1.1 * area}, 400);
      CHECK(levels.level(0) == level);
    }
  }
}

TEST_CASE("a print of few points, whose size depends on the level, does not go from level to level",
          "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  // Between levels its forces are spread over more points of equal area than at any of them.
  for (const double spread : {1.2, 1.5, 1.8})
    for (double area = 4e-6; area < 3e-5; area *= 1.05) {
      detail::PointLevels levels;
      double lowest = 100.0, highest = 0.0;
      for (int i = 0; i < 600; ++i) {
        const double level = levels.level(0);
        const bool is_whole = level == std::floor(level);
        tick(levels, samples, {area}, 400, 1.0, {}, is_whole ? 1.0 : spread);
        if (i < 400) continue;
        lowest = std::min(lowest, levels.level(0));
        highest = std::max(highest, levels.level(0));
      }
      CHECK(lowest == highest);
    }
}

TEST_CASE("where a list has no room for all points near a tool, the tool has fewer", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  detail::PointLevels levels;
  for (int i = 0; i < 50; ++i) tick(levels, samples, {1e-6}, 64);
  const double first = levels.level(0);
  CHECK_FALSE(levels.note_full_list(0));  // it presses: in the next ticks
  const auto tick_with_room = [&](int room) {
    levels.note_room(0, 100, room);
    tick(levels, samples, {1e-6}, 64);
  };
  for (int i = 0; i < 50; ++i) tick_with_room(100);
  CHECK(levels.level(0) == first + 1.0);
  for (int i = 0; i < 50; ++i) tick_with_room(130);
  CHECK(levels.level(0) == first);
}

TEST_CASE("two tools whose prints grow by two thirds in a tick have rows for all points", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  for (double first = 1e-7; first < 2e-7; first *= 1.05) {
    detail::PointLevels levels;
    for (double area = first; area < 6e-6; area *= 1.67) {
      tick(levels, samples, {area, area}, 96);
      CAPTURE(first, area, levels.level(0));
      CHECK(levels.deepest() == 0.0);
    }
  }
}

TEST_CASE("on other points a tool keeps its level, and does not remember where a list was full", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  detail::PointLevels levels;
  for (int i = 0; i < 50; ++i) tick(levels, samples, {1e-6}, 64);
  const double first = levels.level(0);
  levels.note_full_list(0);
  for (int i = 0; i < 50; ++i) tick(levels, samples, {1e-6}, 64);
  REQUIRE(levels.level(0) == first + 1.0);
  levels.change_points();
  CHECK(levels.level(0) == first + 1.0);
  for (int i = 0; i < 50; ++i) tick(levels, samples, {1e-6}, 64);
  CHECK(levels.level(0) == first);
}

TEST_CASE("a tool that begins with a deep press has the level for its area at once", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  detail::PointLevels levels;
  levels.begin_tick(samples, {{{tip_radius, tip_radius}}}, {true}, {64, 24});
  levels.start(samples, 0, 3e-5);
  const double level = levels.level(0);
  CHECK(level > 1.0);
  for (int i = 0; i < 200; ++i) tick(levels, samples, {3e-5}, 64);
  CHECK(levels.level(0) == level);
}

TEST_CASE("rows are divided by need, and never more than there are", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  detail::PointLevels levels;
  const auto settle = [&](const Areas& areas) {
    Counts used{};
    for (int i = 0; i < 400; ++i) used = tick(levels, samples, areas, 100);
    return used;
  };
  const Counts alone = settle({1e-5}), beside = settle({1e-5, 2e-5});
  CHECK(levels.deepest() == 0.0);
  CHECK(std::abs(alone[0] - beside[0]) <= 1);
  Areas all{};
  all.fill(2e-5);
  const Counts many = settle(all);
  CHECK(*std::min_element(many.begin(), many.end()) >= 5);
  CHECK(std::accumulate(many.begin(), many.end(), 0) <= 100);
  CHECK(levels.deepest() == 0.0);  // fewer points each, none without a row
}

TEST_CASE("a tool that rests keeps its level where the points of a finer one do not fit", "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  for (double area = 1.5e-5; area < 6e-5; area *= 1.07) {
    detail::PointLevels levels;
    for (int i = 0; i < 100; ++i) tick(levels, samples, {area, area}, 60, 1.3);
    const double level = levels.level(0);
    int left_out = 0;
    for (int i = 0; i < 100; ++i) {
      tick(levels, samples, {area, area}, 60, 1.3);
      left_out += levels.deepest() > 0.0;
    }
    CAPTURE(area);
    CHECK(std::abs(levels.level(0) - level) < 0.01);
    CHECK((left_out == 0 || left_out == 100));
  }
}

TEST_CASE("levels above the coarsest are for tools without rows for that; flat tools have coarser ones",
          "[contact][levels]") {
  const detail::ContactSamples samples = plane_of_samples();
  const double coarsest = samples.level_with(detail::PointLevels::coarsest_spacing * tip_radius);
  const auto settled = [&](double scale, int capacity) {
    detail::PointLevels levels;
    for (int i = 0; i < 200; ++i) {
      const double area = 1e-4;
      levels.begin_tick(samples, {{{tip_radius, scale}}}, {true}, {capacity, 18});
      const int points = static_cast<int>(area / (0.866 * std::pow(samples.spacing(std::floor(levels.level(0))), 2)));
      const int used = std::min(points, levels.share(0));
      for (int k = used; k < points; ++k) levels.note_left_out(0, 1e-3);
      levels.end_tick({used}, {static_cast<double>(used)}, {});
    }
    return levels.level(0);
  };
  CHECK(settled(tip_radius, 64) == std::round(coarsest));
  CHECK(settled(tip_radius, 24) > coarsest + 0.5);
  CHECK(settled(2.0 * tip_radius, 64) > coarsest + 0.5);
}
