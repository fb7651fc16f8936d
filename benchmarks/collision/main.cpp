// Time to build, to update for a deformed surface and to find the triangles near a tool, for three structures: octree,
// balanced binary tree and bounding volumes. The thesis (6.2) chooses between them by reasoning; here they are
// measured. Results of every structure are compared with an exhaustive search.
//   bench_collision
#include "structures.hpp"

#include <palpate/testing/random.hpp>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <set>

namespace collision { namespace {

constexpr double pi = 3.141592653589793, radius = 0.05;  // radius of the organ [m]
int wrong = 0;

/// A sphere with bumps, of 2 n (2 n - 2) triangles; `wave` is the phase of the bumps.
Surface organ(int n, double wave) {
  Surface s;
  const auto at = [&](double u, double v) {
    const Vector3 d(std::sin(u) * std::cos(v), std::sin(u) * std::sin(v), std::cos(u));
    return Vector3(radius * (1.0 + 0.1 * std::sin(5.0 * u + wave) * std::cos(4.0 * v)) * d);
  };
  s.positions.push_back(at(0.0, 0.0));
  for (int i = 1; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) s.positions.push_back(at(pi * i / n, pi * j / n));
  s.positions.push_back(at(pi, 0.0));
  const int last = static_cast<int>(s.positions.size()) - 1;
  const auto id = [&](int i, int j) { return 1 + 2 * n * (i - 1) + j % (2 * n); };
  for (int j = 0; j < 2 * n; ++j) {
    s.triangles.push_back({0, id(1, j), id(1, j + 1)});
    for (int i = 1; i < n - 1; ++i) {
      s.triangles.push_back({id(i, j), id(i + 1, j), id(i + 1, j + 1)});
      s.triangles.push_back({id(i, j), id(i + 1, j + 1), id(i, j + 1)});
    }
    s.triangles.push_back({last, id(n - 1, j + 1), id(n - 1, j)});
  }
  return s;
}

double now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

template <class Structure>
void measure(const Surface& rest, const Surface& deformed, const std::vector<Vector3>& tools, double reach) {
  double build = infinity, move = infinity, query = infinity;
  for (int round = 0; round < 5; ++round) {
    const double start = now();
    const Structure structure(rest);
    build = std::min(build, now() - start);
  }
  Structure structure(rest);
  Surface other = rest;
  for (int round = 0; round < 5; ++round) {
    other.positions = round % 2 == 0 ? deformed.positions : rest.positions;
    const double start = now();
    structure.moved(other);
    move = std::min(move, now() - start);
  }
  std::size_t found = 0, visited = 0;
  for (int round = 0; round < 7; ++round) {
    found = visited = 0;
    const double start = now();
    for (const Vector3& p : tools)
      structure.near(other, p, reach, [&](int t) {
        ++visited;
        found += other.distance2(t, p) <= reach * reach;
      });
    query = std::min(query, now() - start);
  }
  std::size_t all = 0;
  for (std::size_t k = 0; k < tools.size() && k < 200; ++k) {
    std::set<int> exact, got;
    for (int t = 0; t < static_cast<int>(other.triangles.size()); ++t)
      if (other.distance2(t, tools[k]) <= reach * reach) exact.insert(t);
    structure.near(other, tools[k], reach, [&](int t) {
      if (other.distance2(t, tools[k]) <= reach * reach && !got.insert(t).second) ++wrong;
    });
    if (exact != got) ++wrong;
    all += exact.size();
  }
  if (all == 0) ++wrong;
  const double n = static_cast<double>(tools.size());
  std::printf("%8zu %-21s %9.3f %9.3f %9.3f %8.1f %8.1f\n", rest.triangles.size(), Structure::name, 1e3 * build,
              1e3 * move, 1e6 * query / n, static_cast<double>(visited) / n, static_cast<double>(found) / n);
}

}  // namespace
}  // namespace collision

int main() {
  using namespace collision;
  std::printf("%8s %-21s %9s %9s %9s %8s %8s\n", "", "", "build", "deformed", "query", "looked", "near");
  std::printf("%8s %-21s %9s %9s %9s %8s %8s\n", "faces", "", "ms", "ms", "us", "at", "");
  for (const int n : {12, 36, 112}) {
    const Surface rest = organ(n, 0.0), deformed = organ(n, 0.7);
    testing::Random random(7);
    std::vector<Vector3> tools;  // on the deformed surface or up to 8 mm away from it
    for (int k = 0; k < 2000; ++k) {
      const auto v = static_cast<std::size_t>(random.uniform(0.0, static_cast<double>(rest.positions.size()) - 0.01));
      tools.push_back(deformed.positions[v] * (1.0 + random.uniform(0.0, 0.16)));
    }
    measure<Octree>(rest, deformed, tools, 6e-3);
    measure<BinaryTree>(rest, deformed, tools, 6e-3);
    measure<BoundingVolumes>(rest, deformed, tools, 6e-3);
  }
  if (wrong > 0) std::printf("WRONG: %d results differ from an exhaustive search\n", wrong);
  return wrong == 0 ? 0 : 1;
}
