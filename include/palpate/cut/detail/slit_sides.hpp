// The two sides of the slits in a surface.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <array>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Signs of the lips: vertices that were one, in pairs of different signs, and the vertices of a triangle that are on
/// lips, of the same sign. The first sign that reaches a vertex stays.
inline std::vector<double> lip_signs(const std::vector<std::pair<int, int>>& apart,
                                     const std::vector<std::pair<int, int>>& together, std::size_t count) {
  std::vector<std::vector<std::pair<int, double>>> next(count);
  for (const auto& [a, b] : apart) {
    next[static_cast<std::size_t>(a)].push_back({b, -1.0});
    next[static_cast<std::size_t>(b)].push_back({a, -1.0});
  }
  for (const auto& [a, b] : together) {
    next[static_cast<std::size_t>(a)].push_back({b, 1.0});
    next[static_cast<std::size_t>(b)].push_back({a, 1.0});
  }
  std::vector<double> sign(count, 0.0);
  std::vector<std::size_t> waiting;
  for (const auto& pair : apart) {
    if (sign[static_cast<std::size_t>(pair.first)] != 0.0) continue;
    sign[static_cast<std::size_t>(pair.first)] = 1.0;
    waiting.push_back(static_cast<std::size_t>(pair.first));
    while (!waiting.empty()) {
      const std::size_t at = waiting.back();
      waiting.pop_back();
      for (const auto& [other, relative] : next[at]) {
        double& found = sign[static_cast<std::size_t>(other)];
        if (found != 0.0) continue;
        found = relative * sign[at];
        waiting.push_back(static_cast<std::size_t>(other));
      }
    }
  }
  return sign;
}

/// For every vertex of a surface 1 on one lip of a slit, -1 on the other one, and less away from them; 0 far away, and
/// where a vertex belongs to both. Vertices split from one node are on opposite lips, those of a triangle on the same.
/// `origin[v]` is the same for vertices that were one. O(triangles).
inline std::vector<double> slit_sides(const std::vector<Triangle>& triangles, const std::vector<NodeId>& origin) {
  constexpr int rings = 2;  // around the lips
  const std::size_t count = origin.size();
  std::vector<char> used(count, 0), on_lip(count, 0);
  for (const Triangle& t : triangles)
    for (const int v : t) used[static_cast<std::size_t>(v)] = 1;
  std::vector<std::pair<NodeId, int>> by_origin;
  for (std::size_t v = 0; v < count; ++v)
    if (used[v] != 0) by_origin.push_back({origin[v], static_cast<int>(v)});
  std::ranges::sort(by_origin);
  std::vector<std::pair<int, int>> apart, together;
  for (std::size_t k = 1; k < by_origin.size(); ++k) {
    if (by_origin[k].first != by_origin[k - 1].first) continue;
    apart.push_back({by_origin[k - 1].second, by_origin[k].second});
    for (const std::size_t v : {k - 1, k}) on_lip[static_cast<std::size_t>(by_origin[v].second)] = 1;
  }
  if (apart.empty()) return std::vector<double>(count, 0.0);
  for (const Triangle& t : triangles)
    for (std::size_t k = 0; k < 3; ++k)
      if (const int a = t[k], b = t[(k + 1) % 3];
          on_lip[static_cast<std::size_t>(a)] != 0 && on_lip[static_cast<std::size_t>(b)] != 0)
        together.push_back({a, b});
  const std::vector<double> lips = lip_signs(apart, together, count);
  std::vector<double> side = lips;
  for (int ring = 0; ring < rings; ++ring) {
    std::vector<double> sum(count, 0.0), neighbours(count, 0.0);
    for (const Triangle& t : triangles)
      for (std::size_t k = 0; k < 3; ++k)
        for (const std::size_t other : {(k + 1) % 3, (k + 2) % 3}) {
          sum[static_cast<std::size_t>(t[k])] += side[static_cast<std::size_t>(t[other])];
          neighbours[static_cast<std::size_t>(t[k])] += 1.0;
        }
    for (std::size_t v = 0; v < count; ++v)
      if (lips[v] == 0.0 && neighbours[v] > 0.0) side[v] = sum[v] / neighbours[v];
  }
  return side;
}

}}}  // namespace palpate::detail
