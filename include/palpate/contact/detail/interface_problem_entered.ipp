// What enters another body where no mean gap keeps it out, of interface_problem.hpp: vertices and edges.
#pragma once

#include <palpate/contact/detail/interface_problem.hpp>
#include <palpate/contact/detail/line_crossing.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE InterfaceProblem::NearestFacet InterfaceProblem::find_nearest(const Body& other, const Vector3& p,
                                                                             Index except) const noexcept {
  constexpr double across = 0.7;  // cosine from the normal of the nearest facet: not beside a rim
  constexpr double close = 1e-3;  // of a mean facet: no direction is known
  const double most = std::max(other.facet_length, 2.0 * other.deepest);
  if (other.triangles.empty() || other.bvh.bounds().squared_distance(p) > most * most) return {};
  const auto corner = [&](int t, std::size_t k) { return other.now[at(other.triangles[at(t)][k])]; };
  const auto weights = [&](int t) { return closest_point(p, corner(t, 0), corner(t, 1), corner(t, 2)).weights; };
  const auto from = [&](int t, const std::array<double, 3>& w) {
    return Vector3(p - (w[0] * corner(t, 0) + w[1] * corner(t, 1) + w[2] * corner(t, 2)));
  };
  NearestFacet found;
  found.facet = other.bvh.nearest(p, [&](int t) {
    return except >= 0 && other.parts[at(t)] == except ? infinity : from(t, weights(t)).squaredNorm();
  });
  if (found.facet < 0) return {};
  found.weights = weights(found.facet);
  const Vector3 path = from(found.facet, found.weights), first = corner(found.facet, 0);
  found.normal = cross(corner(found.facet, 1) - first, corner(found.facet, 2) - first).normalized();
  found.height = found.normal.dot(path);
  const bool is_beside = std::abs(found.height) < across * path.norm() && path.norm() > close * other.facet_length;
  if (is_beside || found.height < -beyond_middle * other.depths[at(found.facet)]) return {};
  return found;
}

/// The same only where the facet faces the vertex: deep in a thin body the nearest facet may belong to the far side.
PALPATE_INLINE InterfaceProblem::NearestFacet InterfaceProblem::find_opposite(const Body& own, const Body& other,
                                                                              int v) const noexcept {
  constexpr double opposite = -0.2;  // cosine between the normals
  const NearestFacet found = find_nearest(other, own.now[at(v)]);
  if (found.facet < 0) return found;
  Vector3 normal(0.0, 0.0, 0.0);
  for (const int t : own.tissue.surface().triangles_at(v)) {
    const Triangle& corners = own.triangles[at(t)];
    const Vector3& first = own.now[at(corners[0])];
    normal += cross(own.now[at(corners[1])] - first, own.now[at(corners[2])] - first);
  }
  return normal.dot(found.normal) < opposite * normal.norm() ? found : NearestFacet{};
}

/// A row of the last linearisation that pressed; null if it did not.
PALPATE_INLINE const InterfaceProblem::Row* InterfaceProblem::pressed_row(const InterfaceKey& key) const noexcept {
  const auto old = std::ranges::lower_bound(rows_, key, {}, [](const Row& r) { return r.row.key; });
  return old != rows_.end() && old->row.key == key && old->force > 0.0 ? &*old : nullptr;
}

/// Sets the mean gaps at every vertex that are closed at the present positions, or pressed before.
PALPATE_INLINE void InterfaceProblem::note_closed(std::span<const InterfaceRow> rows) {
  for (Body& body : bodies_) body.closed_gap.assign(body.now.size(), infinity);
  for (const InterfaceRow& row : rows) {
    double gap = 0.0;
    for (const InterfaceTerm& t : row.terms) gap += t.weight * row.normal.dot(bodies_[at(t.body)].now[at(t.vertex)]);
    if (gap >= 0.0 && pressed_row(row.key) == nullptr) continue;
    for (const InterfaceTerm& t : row.terms) {
      double& closed = bodies_[at(t.body)].closed_gap[at(t.vertex)];
      closed = std::min(closed, std::min(0.0, gap));
    }
  }
}

/// Whether a vertex or edge at this height above another surface needs no row of its own. Where a mean gap is closed,
/// or will be, a fiftieth of a facet is allowed beyond it: rows for less would only cost time.
PALPATE_INLINE bool InterfaceProblem::may_enter(const Body& body, int v, double height, double length) const noexcept {
  constexpr double beside_closed = 0.02, elsewhere = 0.002;  // of a mean facet
  const double closed = body.closed_gap[at(v)];
  return closed < infinity ? height - closed > -beside_closed * length : height > -elsewhere * length;
}

/// Rows of vertices that pressed, or that have entered.
PALPATE_INLINE void InterfaceProblem::add_entered(std::size_t k, std::size_t l) {
  constexpr double reach = 0.25;  // of a mean facet
  const Body &own = bodies_[k], &other = bodies_[l];
  for (int v = 0; v < static_cast<int>(own.now.size()); ++v) {
    const NearestFacet b = find_opposite(own, other, v);
    if (b.facet < 0 || b.height > reach * other.facet_length) continue;
    const InterfaceKey key{static_cast<int>(k), static_cast<int>(l), v, InterfacePart::vertex};
    if (pressed_row(key) == nullptr && may_enter(own, v, b.height, other.facet_length)) continue;
    const Triangle& corners = other.triangles[at(b.facet)];
    geometry_.rows().push_back({key,
                                -b.normal,
                                0.0,
                                {{key.body, v, -1.0},
                                 {key.other, corners[0], b.weights[0]},
                                 {key.other, corners[1], b.weights[1]},
                                 {key.other, corners[2], b.weights[2]}}});
  }
}

/// An edge leaves the body along the mean of the normals of the facets that it goes through.
PALPATE_INLINE InterfaceProblem::Crossing InterfaceProblem::find_crossing(const Body& other, const Vector3& from,
                                                                          const Vector3& to) const noexcept {
  const auto corner = [&](int t, std::size_t k) { return other.now[at(other.triangles[at(t)][k])]; };
  const auto normal = [&](int t) {
    return Vector3(cross(corner(t, 1) - corner(t, 0), corner(t, 2) - corner(t, 0)).normalized());
  };
  const Vector3 path = to - from;
  double enters = infinity, leaves = -infinity;
  int first = -1, last = -1;
  other.bvh.visit_along(from, path, 0.0, [&](int t) {
    const auto hit = cross_triangle(from, path, corner(t, 0), corner(t, 1), corner(t, 2));
    if (!hit || !(hit->part >= 0.0 && hit->part <= 1.0)) return 1.0;
    if (!hit->is_along_normal && hit->part < enters) {
      enters = hit->part;
      first = t;
    }
    if (hit->is_along_normal && hit->part > leaves) {
      leaves = hit->part;
      last = t;
    }
    return 1.0;
  });
  if (first < 0 || last < 0 || !(enters < leaves)) return {};
  const Vector3 middle = from + 0.5 * (enters + leaves) * path, out = (normal(first) + normal(last)).normalized();
  Crossing found{0.5 * (enters + leaves), infinity};
  for (const int t : {first, last}) {
    const double depth = normal(t).dot(corner(t, 0) - middle) / normal(t).dot(out);
    if (!(depth < found.depth)) continue;
    found.depth = depth;
    found.facet = t;
    found.out = out;
  }
  if (found.facet < 0) return {};
  found.weights =
      closest_point(middle + found.depth * out, corner(found.facet, 0), corner(found.facet, 1), corner(found.facet, 2))
          .weights;
  return found.depth < beyond_middle * other.depths[at(found.facet)] ? found : Crossing{};
}

template <class Visit>
void InterfaceProblem::visit_crossings(const Body& own, const Body& other, Visit&& visit) const {
  if (other.triangles.empty()) return;
  const Box& bounds = other.bvh.bounds();
  for (const auto& [a, b] : own.edges) {
    if (own.closed_gap[at(a)] < infinity && own.closed_gap[at(b)] < infinity) continue;
    const Vector3 path = own.now[at(b)] - own.now[at(a)];
    if (!bounds.is_crossed(own.now[at(a)], path, 0.0, 1.0)) continue;
    const Crossing c = find_crossing(other, own.now[at(a)], own.now[at(b)]);
    if (c.facet >= 0) visit(a, b, c);
  }
}

/// Whether the points of a row of an edge are still opposite each other, so that it keeps them while they touch.
PALPATE_INLINE bool InterfaceProblem::is_opposite(const InterfaceRow& row, double length) const noexcept {
  constexpr double beside = 0.1, apart = 0.25;  // of a mean facet
  Vector3 between(0.0, 0.0, 0.0);
  for (const InterfaceTerm& t : row.terms) between += t.weight * bodies_[at(t.body)].now[at(t.vertex)];
  const double gap = row.normal.dot(between);
  return gap < apart * length && (between - gap * row.normal).norm() < beside * length;
}

/// Rows of edges that go through the other body although no vertex has entered, and of those that pressed.
PALPATE_INLINE void InterfaceProblem::add_crossings(std::size_t k, std::size_t l) {
  const int own = static_cast<int>(k), other = static_cast<int>(l);
  const double length = bodies_[l].facet_length;
  const std::size_t first = geometry_.rows().size();
  visit_crossings(bodies_[k], bodies_[l], [&](int a, int b, const Crossing& c) {
    const InterfaceKey key{own, other, a, InterfacePart::edge, b};
    if (pressed_row(key) == nullptr &&
        (may_enter(bodies_[k], a, -c.depth, length) || may_enter(bodies_[k], b, -c.depth, length)))
      return;
    const Triangle& corners = bodies_[l].triangles[at(c.facet)];
    geometry_.rows().push_back({key,
                                -c.out,
                                0.0,
                                {{own, a, c.along - 1.0},
                                 {own, b, -c.along},
                                 {other, corners[0], c.weights[0]},
                                 {other, corners[1], c.weights[1]},
                                 {other, corners[2], c.weights[2]}}});
  });
  const std::size_t crossing = geometry_.rows().size();
  for (const Row& r : rows_) {
    const InterfaceKey& key = r.row.key;
    if (key.body != own || key.other != other || key.part != InterfacePart::edge || !(r.force > 0.0) ||
        !is_opposite(r.row, length))
      continue;
    const auto begin = geometry_.rows().begin() + static_cast<std::ptrdiff_t>(first),
               end = geometry_.rows().begin() + static_cast<std::ptrdiff_t>(crossing);
    if (std::none_of(begin, end, [&](const InterfaceRow& row) { return row.key == key; }))
      geometry_.rows().push_back(r.row);
  }
}

/// Whether a vertex of a part is inside another part.
PALPATE_INLINE bool InterfaceProblem::parts_have_entered(const Body& body) const noexcept {
  constexpr double allowed = 0.03;  // of a mean facet
  for (int v = 0; v < static_cast<int>(body.now.size()) && !body.parts.empty(); ++v) {
    const auto facets = body.tissue.surface().triangles_at(v);
    if (!facets.empty() &&
        find_nearest(body, body.now[at(v)], body.parts[at(facets.front())]).height < -allowed * body.facet_length)
      return true;
  }
  return false;
}

PALPATE_INLINE bool InterfaceProblem::has_entered() const noexcept {
  constexpr double beside_closed = 0.03, elsewhere = 0.01;  // allowed, of a mean facet
  bool found = std::ranges::any_of(bodies_, [this](const Body& body) { return parts_have_entered(body); });
  for (const Body& own : bodies_)
    for (const Body& other : bodies_) {
      if (&own == &other || found) continue;
      const auto allowed = [&](std::size_t v) {
        return (own.closed_gap[v] < infinity ? beside_closed : elsewhere) * other.facet_length;
      };
      for (std::size_t v = 0; v < own.now.size() && !found; ++v)
        found = !own.tissue.surface().triangles_at(static_cast<int>(v)).empty() &&
                find_nearest(other, own.now[v]).height < -allowed(v);
      if (!found)
        visit_crossings(own, other, [&](int a, int b, const Crossing& c) {
          found = found || c.depth > std::max(allowed(at(a)), allowed(at(b)));
        });
    }
  return found;
}

/// Whether tissues overlap, before they move each other, by a tenth of the thickness of the thinner one. Rigid parts
/// move out of the way.
PALPATE_INLINE bool InterfaceProblem::overlap_at_rest() {
  constexpr double large = 0.2;  // of a depth, half of the thickness
  for (Body& body : bodies_) {
    for (std::size_t v = 0; v < body.now.size(); ++v)
      body.now[v] = body.pose * body.tissue.surface().position(static_cast<int>(v));
    body.bvh.refit(body.triangles, body.now);
  }
  for (const Body& own : bodies_)
    for (const Body& other : bodies_)
      for (int v = 0;
           &own != &other && own.parts.empty() && other.parts.empty() && v < static_cast<int>(own.now.size()); ++v) {
        const NearestFacet b = find_opposite(own, other, v);
        if (b.facet < 0) continue;
        double depth = other.depths[at(b.facet)];
        for (const int t : own.tissue.surface().triangles_at(v)) depth = std::min(depth, own.depths[at(t)]);
        if (-b.height > large * depth) return true;
      }
  return false;
}

}}}  // namespace palpate::detail
