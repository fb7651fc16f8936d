// The material points of a surface at which contact is enforced.
#pragma once

#include <palpate/contact/contact_surface.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A material point of the contact surface: three vertices, and the weights that interpolate their displacement and
/// distribute its force.
struct ContactSample {
  Triangle vertices{};
  std::array<double, 3> weights{};
};

/// Points spread over all triangles so that no two neighbours are further apart than `spacing`, as far as
/// `maximum_subdivision` allows: all vertices, and a barycentric lattice on longer edges and faces. They are fixed in
/// the material, so that a sphere sliding over them encounters a smooth sequence of constraints. Every sample belongs
/// to one triangle. Tools of different size use levels of different spacing; samples are numbered through all levels.
class ContactSamples {
 public:
  ContactSamples() = default;

  /// Largest number of parts of an edge: limits the lattice on very coarse triangles, and with it the work of a tick.
  static constexpr int maximum_subdivision = 32;
  /// Lengths and radii that differ by less, relatively, count as equal.
  static constexpr double rounding = 1e-6;

  /// One level. Allocates; for set-up.
  ContactSamples(const ContactSurface& surface, double spacing);

  /// Adds a level of larger spacing [m] with the next number. Allocates; for set-up.
  void add_level(const ContactSurface& surface, double spacing);
  int levels() const noexcept { return static_cast<int>(first_.size()); }
  int level_of(int sample) const noexcept;

  /// Fewer points: those whose `density` is below a bound [1/m^2] are spread evenly over the surface, about that many
  /// per area, or all where there are fewer.
  double density(int sample) const noexcept { return density_[static_cast<std::size_t>(sample)]; }
  /// An upper bound of all densities.
  double densest() const noexcept { return densest_; }

  /// The samples that belong to a triangle.
  std::span<const ContactSample> of_triangle(int t, int level = 0) const noexcept {
    return {samples_.data() + first_of(t, level),
            static_cast<std::size_t>(first_of(t + 1, level) - first_of(t, level))};
  }
  int count() const noexcept { return static_cast<int>(samples_.size()); }
  const ContactSample& operator[](int sample) const noexcept { return samples_[static_cast<std::size_t>(sample)]; }
  /// The sample of a level nearest to a sample of another surface whose vertices have the same numbers; -1 when its
  /// triangles no longer exist. Checks the triangles around a vertex; no allocation.
  int nearest(const ContactSurface& surface, const ContactSample& wanted, int level = 0) const noexcept;
  /// The first sample at a vertex; -1 at a vertex without triangles. Checks the triangles around it; no allocation.
  int of_vertex(const ContactSurface& surface, int vertex) const noexcept;
  /// Number of the first sample of a triangle; those of triangle t end where those of t + 1 begin.
  int first_of(int t, int level = 0) const noexcept {
    return first_[static_cast<std::size_t>(level)][static_cast<std::size_t>(t)];
  }

 private:
  void add_triangle(const ContactSurface& surface, int number, double spacing, std::vector<bool>& vertex_taken);
  void add_edge(const ContactSurface& surface, int number, std::size_t i, double spacing);

  void rank_level(const ContactSurface& surface, int first);

  std::vector<ContactSample> samples_;
  std::vector<float> density_;
  double densest_ = 0.0;
  std::vector<std::vector<int>> first_;  // of every level; per triangle, one past the end last
};

/// Length of the longest edge of a surface [m].
double longest_edge(const ContactSurface& surface) noexcept;

/// Throws SetupError(bad_argument) when the longest edge is longer than a lattice with a spacing of one radius can
/// cover (ids: its vertices). The message states whether the edge is that long only because the scene's loads stretch
/// it.
void require_dense_points(const ContactSurface& surface, double radius);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/contact_samples.ipp>
#endif
