// Definitions of force_accuracy.hpp.
#pragma once

#include <palpate/contact/force_accuracy.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE ForceAccuracy::ForceAccuracy(double radius, std::vector<detail::MissingDepth> places,
                                            std::vector<Vertex> vertices)
    : radius_(radius), places_(std::move(places)), vertices_(std::move(vertices)) {}

namespace detail {

PALPATE_INLINE MissingDepth::Level MissingDepth::at(std::size_t position, double force) const noexcept {
  const std::vector<Level>& known = levels[position];
  if (known.empty()) return {force, 0.0, infinity};
  Level low{};
  for (const Level& high : known) {
    if (force <= high.force) {
      const double t = (force - low.force) / (high.force - low.force);
      return {force, low.missing + t * (high.missing - low.missing), low.doubt + t * (high.doubt - low.doubt)};
    }
    low = high;
  }
  const double beyond = force / low.force - 1.0;
  return {force, low.missing, low.doubt + beyond * (std::abs(low.missing) + low.doubt)};
}

}  // namespace detail

/// Contact points on facets distribute their force to the vertices. The loads are added per vertex; beyond `capacity`
/// vertices the contact is so large that the position over a facet does not matter, and the rest is ignored.
PALPATE_INLINE ForceAccuracy::Loads ForceAccuracy::largest_loads(int number,
                                                                 std::span<const Contact> contacts) noexcept {
  constexpr int capacity = 24, unused = -1;
  constexpr std::size_t slot_count = 64;  // of a hash table from vertices to their numbers here
  std::array<int, capacity> vertices;
  std::array<double, capacity> loads;
  std::array<signed char, slot_count> numbers;
  numbers.fill(unused);
  int count = 0;
  for (const Contact& c : contacts) {
    if (c.tool != number || !(c.force > 0.0)) continue;
    for (std::size_t a = 0; a < 3; ++a) {
      if (!(c.weights[a] > 0.0)) continue;
      auto slot = static_cast<std::size_t>(c.vertices[a]) % slot_count;
      while (numbers[slot] != unused && vertices[static_cast<std::size_t>(numbers[slot])] != c.vertices[a])
        slot = (slot + 1) % slot_count;
      if (numbers[slot] == unused) {
        if (count == capacity) continue;
        vertices[static_cast<std::size_t>(count)] = c.vertices[a];
        loads[static_cast<std::size_t>(count)] = 0.0;
        numbers[slot] = static_cast<signed char>(count++);
      }
      loads[static_cast<std::size_t>(numbers[slot])] += c.weights[a] * c.force;
    }
  }
  Loads largest;
  for (int i = 0; i < count; ++i) {
    const auto at = static_cast<std::size_t>(i);
    std::size_t k = 3;
    while (k > 0 && (largest.vertex[k - 1] < 0 || largest.share[k - 1] < loads[at])) --k;
    if (k == 3) continue;
    for (std::size_t j = 2; j > k; --j) {
      largest.vertex[j] = largest.vertex[j - 1];
      largest.share[j] = largest.share[j - 1];
    }
    largest.vertex[k] = vertices[at];
    largest.share[k] = loads[at];
  }
  const double sum = largest.share[0] + largest.share[1] + largest.share[2];
  for (double& s : largest.share) s = sum > 0.0 ? s / sum : 0.0;
  return largest;
}

PALPATE_INLINE ForceError ForceAccuracy::error_without_force(int vertex) const noexcept {
  const Vertex& at = vertices_[static_cast<std::size_t>(vertex)];
  const detail::MissingDepth& place = places_[static_cast<std::size_t>(at.place)];
  const double unseen = *std::max_element(place.unseen.begin(), place.unseen.end()) / at.softness;
  return {0.0, unseen, 0.0, {unseen}};
}

/// The shares of the three largest loads, descending, are barycentric coordinates of the sphere over a facet: (1, 0, 0)
/// over a vertex, (1/2, 1/2, 0) over an edge, (1/3, 1/3, 1/3) over the middle. In between the error is linear.
PALPATE_INLINE ForceError ForceAccuracy::error(const ContactTool& tool, int number, std::span<const Contact> contacts,
                                               double depth) const noexcept {
  constexpr double most = 1.25;            // ratio of radii
  constexpr double position_doubt = 0.15;  // share of the largest error of the place
  const double force = tool.force.norm();
  if (!(tool.radius <= most * radius_ && most * tool.radius >= radius_) || tool.half_length > 0.0) return {};
  const Loads loads = largest_loads(number, contacts);
  if (loads.vertex[0] < 0 || !(depth > 0.0)) return {};
  const std::array<double, 3> part{loads.share[0] - loads.share[1], 2.0 * (loads.share[1] - loads.share[2]),
                                   3.0 * loads.share[2]};
  const double at = force * tool.radius / radius_;                          // same contact radius
  const double contact = 4.0 * tool.radius * std::min(depth, tool.radius);  // square of its diameter
  const auto hidden = [&](double facet) { return facet * facet / (facet * facet + contact); };
  double missing = 0.0, doubt = 0.0;
  for (std::size_t k = 0; k < 3 && loads.vertex[k] >= 0; ++k) {
    const Vertex& vertex = vertices_[static_cast<std::size_t>(loads.vertex[k])];
    const detail::MissingDepth& place = places_[static_cast<std::size_t>(vertex.place)];
    const double scale = loads.share[k] * hidden(vertex.facet_length) / hidden(place.facet_length);
    double largest = 0.0;
    for (std::size_t p = 0; p < detail::MissingDepth::positions; ++p) {
      const detail::MissingDepth::Level level = place.at(p, at * vertex.softness);
      if (part[p] > 0.0) {
        missing += scale * part[p] * level.missing;
        doubt += loads.share[k] * part[p] * level.doubt;
      }
      largest = std::max(largest, std::abs(level.missing));
    }
    doubt += scale * position_doubt * largest;
  }
  const double relative = std::max(missing / depth, -0.9);
  const double expected = force * relative / (1.0 + relative);
  return {expected, std::abs(expected) + force * doubt / depth};
}

}}  // namespace palpate
