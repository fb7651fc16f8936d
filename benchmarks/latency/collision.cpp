// Sphere against triangles: the hierarchy, compared with brute force.
#include <map>
#include <memory>
#include <palpate/contact/contact_surface.hpp>
#include <random>

#include "sampling.hpp"

#include <cmath>

namespace {

using namespace palpate;

/// A wavy sheet of 0.1 m per side with 2 n^2 triangles, and 256 spheres that touch it.
struct Sheet {
  std::vector<Vector3> positions, moved;
  std::vector<Triangle> triangles;
  std::vector<Vector3> centres;
  ContactSurface surface;
  static constexpr double radius = 4e-3;

  static Vector3 point(double x, double y, double phase) {
    return {x, y, 5e-3 * std::sin(80.0 * x + phase) * std::cos(70.0 * y)};
  }
  explicit Sheet(int n) {
    const auto vertex = [n](int i, int j) { return i + (n + 1) * j; };
    for (int j = 0; j <= n; ++j)
      for (int i = 0; i <= n; ++i) {
        positions.push_back(point(0.1 * i / n, 0.1 * j / n, 0.0));
        moved.push_back(point(0.1 * i / n, 0.1 * j / n, 0.1));
      }
    for (int j = 0; j < n; ++j)
      for (int i = 0; i < n; ++i) {
        triangles.push_back({vertex(i, j), vertex(i + 1, j), vertex(i + 1, j + 1)});
        triangles.push_back({vertex(i, j), vertex(i + 1, j + 1), vertex(i, j + 1)});
      }
    std::mt19937 random(7);
    std::uniform_real_distribution<double> inside(0.01, 0.09);
    for (int i = 0; i < 256; ++i) {
      const double x = inside(random), y = inside(random);
      centres.push_back(point(x, y, 0.0) + Vector3(0.0, 0.0, 0.75 * radius));
    }
    surface = ContactSurface(positions, triangles);
  }

  double squared_distance(int t, const Vector3& p) const noexcept {
    const Triangle& v = triangles[static_cast<std::size_t>(t)];
    const auto at = [&](int i) -> const Vector3& { return positions[static_cast<std::size_t>(i)]; };
    const detail::TrianglePoint on = detail::closest_point(p, at(v[0]), at(v[1]), at(v[2]));
    return (p - (on.weights[0] * at(v[0]) + on.weights[1] * at(v[1]) + on.weights[2] * at(v[2]))).squaredNorm();
  }
  int count_near(const Vector3& p) const noexcept {
    int count = 0;
    surface.bvh().visit_near(p, radius, [&](int t) { count += squared_distance(t, p) <= radius * radius; });
    return count;
  }
  int brute_count(const Vector3& p) const noexcept {
    int count = 0;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) count += squared_distance(t, p) <= radius * radius;
    return count;
  }
  double brute_distance(const Vector3& p) const noexcept {
    double best = infinity;
    for (int t = 0; t < static_cast<int>(triangles.size()); ++t) best = std::min(best, squared_distance(t, p));
    return std::sqrt(best);
  }
};

const Sheet& sheet(benchmark::State& state) {
  static std::map<int, std::unique_ptr<Sheet>> made;
  auto& s = made[static_cast<int>(state.range(0))];
  if (!s) s = std::make_unique<Sheet>(static_cast<int>(state.range(0)));
  state.counters["triangles"] = static_cast<double>(s->triangles.size());
  return *s;
}

/// Times query(centre) over the spheres.
template <class Query>
void over_spheres(benchmark::State& state, const Sheet& s, Query query) {
  std::size_t i = 0;
  for (auto _ : state) benchmark::DoNotOptimize(query(s.centres[++i % s.centres.size()]));
}

void all_in_sphere(benchmark::State& state) {
  const Sheet& s = sheet(state);
  over_spheres(state, s, [&](const Vector3& p) { return s.count_near(p); });
  int hits = 0;
  for (const Vector3& p : s.centres) {
    hits += s.count_near(p);
    if (s.count_near(p) != s.brute_count(p)) return state.SkipWithError("the hierarchy misses triangles");
  }
  state.counters["hits"] = hits / static_cast<double>(s.centres.size());
}
void closest(benchmark::State& state) {
  const Sheet& s = sheet(state);
  over_spheres(state, s, [&](const Vector3& p) { return s.surface.closest(p).distance; });
  for (const Vector3& p : s.centres)
    if (std::abs(std::abs(s.surface.closest(p).distance) - s.brute_distance(p)) > 1e-15)
      return state.SkipWithError("the closest triangle is wrong");
}
void refit(benchmark::State& state) {
  const Sheet& s = sheet(state);
  detail::Bvh bvh(s.triangles, s.positions);
  bool there = false;
  for (auto _ : state) bvh.refit(s.triangles, (there = !there) ? s.moved : s.positions);
  bvh.refit(s.triangles, s.positions);
  for (const Vector3& p : s.centres) {
    const auto distance = [&](int t) { return s.squared_distance(t, p); };
    if (bvh.nearest(p, distance) != s.surface.bvh().nearest(p, distance)) state.SkipWithError("refit lost triangles");
  }
}
void brute_in_sphere(benchmark::State& state) {
  const Sheet& s = sheet(state);
  over_spheres(state, s, [&](const Vector3& p) { return s.brute_count(p); });
}
void brute_closest(benchmark::State& state) {
  const Sheet& s = sheet(state);
  over_spheres(state, s, [&](const Vector3& p) { return s.brute_distance(p); });
}

void sizes(benchmark::internal::Benchmark* b) {
  b->Arg(50)->Arg(100)->Arg(224)->Unit(benchmark::kMicrosecond);
}
BENCHMARK(all_in_sphere)->Name("bvh/all_in_sphere")->Apply(sizes);
BENCHMARK(closest)->Name("bvh/closest")->Apply(sizes);
BENCHMARK(refit)->Name("bvh/refit")->Apply(sizes);
BENCHMARK(brute_in_sphere)->Name("brute/all_in_sphere")->Apply(sizes);
BENCHMARK(brute_closest)->Name("brute/closest")->Apply(sizes);

}  // namespace
