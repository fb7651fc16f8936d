// Definitions of contact_samples.hpp.
#pragma once

#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Sum of the absolute differences of the weights.
inline double difference(const ContactSample& a, const ContactSample& b) noexcept {
  double sum = 2.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (a.vertices[i] == b.vertices[j]) sum -= 2.0 * std::min(a.weights[i], b.weights[j]);
  return sum;
}

/// An edge of a whole number of spacings has one part more, as if it were longer, whether rounding made it so or not:
/// coordinates in float are rounded by 1e-7. A rotated or scaled copy of the surface then has the same points.
inline int subdivision(double length, double spacing) {
  const double parts = std::ceil((1.0 + ContactSamples::rounding) * length / spacing);
  return static_cast<int>(std::clamp(parts, 1.0, static_cast<double>(ContactSamples::maximum_subdivision)));
}

/// Whether this edge occurs in no triangle before t, and not in t before its i-th edge.
inline bool is_new_edge(const ContactSurface& surface, int t, std::size_t i) noexcept {
  const Triangle& own = surface.triangle(t);
  const int a = own[i], b = own[(i + 1) % 3];
  for (const int other : surface.triangles_at(a)) {
    const Triangle& v = surface.triangle(other);
    for (std::size_t k = 0; k < 3; ++k) {
      const bool is_before = other < t || (other == t && k < i);
      const int c = v[k], d = v[(k + 1) % 3];
      if (is_before && ((c == a && d == b) || (c == b && d == a))) return false;
    }
  }
  return true;
}

/// The coordinates of a point in a box, 20 bits each, digit by digit in turn.
inline std::uint64_t morton_code(const Vector3& x, const Box& box) noexcept {
  const Vector3 size = box.size();
  const double side = std::max({size[0], size[1], size[2]});
  std::uint64_t code = 0;
  for (int i = 0; i < 3; ++i) {
    const double part = side > 0.0 ? std::clamp((x[i] - box.low[i]) / side, 0.0, 1.0) : 0.0;
    const auto digits = static_cast<std::uint64_t>(part * 1048575.0);
    for (int bit = 0; bit < 20; ++bit) code |= (digits >> bit & 1u) << (3 * bit + i);
  }
  return code;
}

/// The binary digits of a number below 2^24 in reverse order behind the point.
inline double reversed_digits(std::size_t number) noexcept {
  double value = 0.0, digit = 0.5;
  for (; number != 0; number >>= 1, digit *= 0.5)
    if (number & 1u) value += digit;
  return value;
}

/// Length of an edge without loads; infinity if not known.
inline double unloaded_length(const ContactSurface& surface, std::int64_t a, std::int64_t b) {
  const std::vector<Vector3>& x = surface.unloaded().positions;
  if (x.size() != surface.positions().size()) return infinity;
  return (x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)]).norm();
}

}  // namespace detail

PALPATE_INLINE ContactSamples::ContactSamples(const ContactSurface& surface, double spacing) {
  add_level(surface, spacing);
}

PALPATE_INLINE void ContactSamples::add_level(const ContactSurface& surface, double spacing) {
  std::vector<bool> vertex_taken(static_cast<std::size_t>(surface.vertex_count()), false);
  std::vector<int> first{count()};
  for (int number = 0; number < static_cast<int>(surface.triangles().size()); ++number) {
    add_triangle(surface, number, spacing, vertex_taken);
    first.push_back(count());
  }
  rank_level(surface, first.front());
  first_.push_back(std::move(first));
}

/// Along a curve that fills space, neighbours in the order are neighbours in space (Morton 1966): reversed binary
/// digits of the number in that order are low for points that are spread evenly (van der Corput 1935).
PALPATE_INLINE void ContactSamples::rank_level(const ContactSurface& surface, int first) {
  std::vector<std::pair<std::uint64_t, int>> order;
  order.reserve(samples_.size() - static_cast<std::size_t>(first));
  Box box;
  for (const Vector3& x : surface.positions()) box.include(x);
  for (int s = first; s < count(); ++s) {
    const ContactSample& c = (*this)[s];
    Vector3 x = Vector3::Zero();
    for (std::size_t a = 0; a < 3; ++a) x += c.weights[a] * surface.position(c.vertices[a]);
    order.emplace_back(detail::morton_code(x, box), s);
  }
  std::sort(order.begin(), order.end());
  for (std::size_t i = 0; i < order.size(); ++i) {
    float& density = density_[static_cast<std::size_t>(order[i].second)];
    densest_ = std::max(densest_, 1.01 * static_cast<double>(density));
    density *= static_cast<float>(detail::reversed_digits(i));
  }
}

PALPATE_INLINE void ContactSamples::add_triangle(const ContactSurface& surface, int number, double spacing,
                                                 std::vector<bool>& vertex_taken) {
  const Triangle& t = surface.triangle(number);
  double longest = 0.0;
  for (std::size_t i = 0; i < 3; ++i) {
    longest = std::max(longest, (surface.position(t[i]) - surface.position(t[(i + 1) % 3])).norm());
    if (!vertex_taken[static_cast<std::size_t>(t[i])])
      samples_.push_back({{t[i], t[(i + 1) % 3], t[(i + 2) % 3]}, {1.0, 0.0, 0.0}});
    vertex_taken[static_cast<std::size_t>(t[i])] = true;
  }
  for (std::size_t i = 0; i < 3; ++i) add_edge(surface, number, i, spacing);
  const int n = detail::subdivision(longest, spacing);
  for (int a = 1; a < n - 1; ++a)
    for (int b = 1; b < n - a; ++b)
      samples_.push_back(
          {t, {static_cast<double>(a) / n, static_cast<double>(b) / n, static_cast<double>(n - a - b) / n}});
  // n^2 / 2 points per triangle, since vertices and edges belong to several. A flat triangle has a large, finite
  // density.
  const Vector3 x = surface.position(t[0]);
  const double area = 0.5 * cross(surface.position(t[1]) - x, surface.position(t[2]) - x).norm();
  density_.resize(samples_.size(), static_cast<float>(0.5 * n * n / std::max(area, 1e-6 * longest * longest)));
}

PALPATE_INLINE int ContactSamples::level_of(int sample) const noexcept {
  int level = levels() - 1;
  while (level > 0 && sample < first_of(0, level)) --level;
  return level;
}

PALPATE_INLINE void ContactSamples::add_edge(const ContactSurface& surface, int number, std::size_t i, double spacing) {
  if (!detail::is_new_edge(surface, number, i)) return;
  const Triangle& t = surface.triangle(number);
  const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
  const int n = detail::subdivision((surface.position(a) - surface.position(b)).norm(), spacing);
  for (int k = 1; k < n; ++k)
    samples_.push_back({{a, b, c}, {1.0 - static_cast<double>(k) / n, static_cast<double>(k) / n, 0.0}});
}

PALPATE_INLINE int ContactSamples::nearest(const ContactSurface& surface, const ContactSample& wanted,
                                           int level) const noexcept {
  int best = -1;
  // A cut body that is restored has fewer vertices.
  if (wanted.vertices[0] >= surface.vertex_count()) return best;
  double least = 1.0;  // with half of the weight on other vertices it is a different place
  for (const int t : surface.triangles_at(wanted.vertices[0]))
    for (int s = first_of(t, level); s < first_of(t + 1, level); ++s)
      if (const double off = detail::difference((*this)[s], wanted); off < least) least = off, best = s;
  return best;
}

PALPATE_INLINE int ContactSamples::of_vertex(const ContactSurface& surface, int vertex) const noexcept {
  for (const int t : surface.triangles_at(vertex))  // the samples of a triangle begin with those at its corners
    for (int s = first_of(t); s < std::min(first_of(t) + 3, first_of(t + 1)); ++s)
      if ((*this)[s].vertices[0] == vertex && (*this)[s].weights[0] == 1.0) return s;
  return -1;
}

PALPATE_INLINE double longest_edge(const ContactSurface& surface) noexcept {
  double longest = 0.0;
  for (const Triangle& t : surface.triangles())
    for (std::size_t i = 0; i < 3; ++i)
      longest = std::max(longest, (surface.position(t[i]) - surface.position(t[(i + 1) % 3])).norm());
  return longest;
}

PALPATE_INLINE void require_dense_points(const ContactSurface& surface, double radius) {
  const double most = ContactSamples::maximum_subdivision * radius;
  SetupProblem problem;
  problem.value = problem.threshold = most;
  for (const Triangle& t : surface.triangles())
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      const double length = (surface.position(a) - surface.position(b)).norm();
      if (!(length > problem.value)) continue;
      problem.value = length;
      problem.ids = {a, b};
    }
  if (problem.ids.empty()) return;
  problem.count = 2;
  const std::string bound = ", more than " + std::to_string(ContactSamples::maximum_subdivision) +
                            " radii of the smallest tool (" + number(radius) +
                            " m): it would fall through; the ids are vertices of the surface";
  const double unloaded = detail::unloaded_length(surface, problem.ids[0], problem.ids[1]);
  if (unloaded <= most) {
    problem.what = "the scene's loads (" + surface.unloaded().loads +
                   ") stretch an edge of the touchable surface from " + number(unloaded) + " m to " +
                   number(problem.value) + " m" + bound;
    problem.hint =
        "Loads should not deform the body that much: check stiffness (Pa), density (kg/m^3), the unit of length of the "
        "mesh (m) and the supports of the body";
  } else {
    problem.what = "an edge of the touchable surface is " + number(problem.value) + " m long" + bound;
    problem.hint = "Refine the mesh where tools touch, or use a larger tool";
  }
  raise(std::move(problem));
}

}}  // namespace palpate
