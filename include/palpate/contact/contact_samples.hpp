// The material points of a surface at which contact is enforced.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/setup_error.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A material point of the contact surface: three vertices and the weights by which it reads their displacement and
/// spreads its force.
struct ContactSample {
  Triangle vertices{};
  std::array<double, 3> weights{};
};

/// Points spread over all triangles so that no two neighbours are further apart than `spacing`, as far as
/// `maximum_subdivision` allows: all vertices, and a barycentric lattice on edges and faces that are longer. Fixed in
/// the material, so that a ball sliding over them meets a smooth sequence of constraints. Every sample belongs to one
/// triangle.
class ContactSamples {
 public:
  ContactSamples() = default;

  /// Parts of an edge: they bound the lattice on very coarse triangles, and with it what a tick may have to look at.
  static constexpr int maximum_subdivision = 32;

  /// Allocates; for set-up.
  ContactSamples(const ContactSurface& surface, double spacing) {
    std::vector<bool> vertex_taken(static_cast<std::size_t>(surface.vertex_count()), false);
    std::map<std::pair<int, int>, bool> edge_taken;
    first_.push_back(0);
    for (const Triangle& t : surface.triangles()) {
      double longest = 0.0;
      for (std::size_t i = 0; i < 3; ++i) {
        longest = std::max(longest, (surface.position(t[i]) - surface.position(t[(i + 1) % 3])).norm());
        if (!vertex_taken[static_cast<std::size_t>(t[i])])
          samples_.push_back({{t[i], t[(i + 1) % 3], t[(i + 2) % 3]}, {1.0, 0.0, 0.0}});
        vertex_taken[static_cast<std::size_t>(t[i])] = true;
      }
      for (std::size_t i = 0; i < 3; ++i) add_edge(surface, t, i, spacing, edge_taken);
      const int n = subdivision(longest, spacing);
      for (int a = 1; a < n - 1; ++a)
        for (int b = 1; b < n - a; ++b)
          samples_.push_back(
              {t, {static_cast<double>(a) / n, static_cast<double>(b) / n, static_cast<double>(n - a - b) / n}});
      first_.push_back(static_cast<int>(samples_.size()));
    }
  }

  /// The samples that belong to a triangle.
  std::span<const ContactSample> of_triangle(int t) const noexcept {
    const auto i = static_cast<std::size_t>(t);
    return {samples_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
  }
  int count() const noexcept { return static_cast<int>(samples_.size()); }
  const ContactSample& operator[](int sample) const noexcept { return samples_[static_cast<std::size_t>(sample)]; }
  /// The sample nearest to one of another surface whose vertices have the same numbers here, -1 when its triangles are
  /// gone. Looks at the triangles around a vertex; no allocation.
  int nearest(const ContactSurface& surface, const ContactSample& wanted) const noexcept {
    int best = -1;
    double least = 1.0;  // half of the weight on other vertices is another place
    for (const int t : surface.triangles_at(wanted.vertices[0]))
      for (int s = first_of(t); s < first_of(t + 1); ++s)
        if (const double off = difference((*this)[s], wanted); off < least) least = off, best = s;
    return best;
  }
  /// Number of the first sample of a triangle; those of triangle t end where those of t + 1 begin.
  int first_of(int t) const noexcept { return first_[static_cast<std::size_t>(t)]; }

 private:
  /// Sum of the differences of weights.
  static double difference(const ContactSample& a, const ContactSample& b) noexcept {
    double sum = 2.0;
    for (std::size_t i = 0; i < 3; ++i)
      for (std::size_t j = 0; j < 3; ++j)
        if (a.vertices[i] == b.vertices[j]) sum -= 2.0 * std::min(a.weights[i], b.weights[j]);
    return sum;
  }
  static int subdivision(double length, double spacing) {
    return static_cast<int>(std::clamp(std::ceil(length / spacing), 1.0, static_cast<double>(maximum_subdivision)));
  }

  void add_edge(const ContactSurface& surface, const Triangle& t, std::size_t i, double spacing,
                std::map<std::pair<int, int>, bool>& taken) {
    const int a = t[i], b = t[(i + 1) % 3], c = t[(i + 2) % 3];
    bool& done = taken[std::pair(std::min(a, b), std::max(a, b))];
    if (done) return;
    done = true;
    const int n = subdivision((surface.position(a) - surface.position(b)).norm(), spacing);
    for (int k = 1; k < n; ++k)
      samples_.push_back({{a, b, c}, {1.0 - static_cast<double>(k) / n, static_cast<double>(k) / n, 0.0}});
  }

  std::vector<ContactSample> samples_;
  std::vector<int> first_;  // per triangle, one past the end last
};

/// Throws SetupError(bad_argument) when the longest edge is longer than the lattice covers at one radius between points
/// (ids: its vertices).
inline void require_dense_points(const ContactSurface& surface, double radius) {
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
  problem.what = "an edge of the touchable surface is " + number(problem.value) + " m long, more than " +
                 std::to_string(ContactSamples::maximum_subdivision) + " radii of the smallest tool (" +
                 number(radius) + " m): it would fall through";
  problem.hint = "Refine the mesh where tools touch, or take a larger tool";
  raise(std::move(problem));
}

}}  // namespace palpate
