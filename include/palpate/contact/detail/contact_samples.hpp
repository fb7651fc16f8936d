// The material points of a surface at which contact is enforced.
#pragma once

#include <palpate/contact/contact_surface.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A material point of the contact surface: three vertices, and the weights that interpolate their displacement and
/// distribute its force.
struct ContactSample {
  Triangle vertices{};
  std::array<double, 3> weights{};
};

/// Points spread over all triangles, fixed in the material: all vertices, and a barycentric lattice on longer edges and
/// faces. Every sample belongs to one triangle.
///
/// Level 0 has all of them. Each further level has some of the level before, evenly spread, with a spacing that is
/// sqrt(2) as large. Every point stands for a part of the surface: that of the points of level 0 that are nearest to it
/// (Voronoi 1908). Between two levels the areas are interpolated, so that points fade in and out. A number of points
/// can thus be chosen for a contact of any size on a mesh of any fineness.
class ContactSamples {
 public:
  ContactSamples() = default;

  /// Largest number of parts of an edge: limits the lattice on very coarse triangles.
  static constexpr int maximum_subdivision = 32;
  /// Lengths and radii that differ by less, relatively, count as equal.
  static constexpr double rounding = 1e-6;

  /// Neighbours of level 0 are at most `finest` [m] apart, as far as `maximum_subdivision` allows; there are levels up
  /// to a spacing of about `coarsest` [m]. Allocates; for set-up. O(samples x levels).
  ContactSamples(const ContactSurface& surface, double finest, double coarsest = 0.0);

  int count() const noexcept { return static_cast<int>(samples_.size()); }
  const ContactSample& operator[](int sample) const noexcept { return samples_[at(sample)]; }
  /// At least one.
  int levels() const noexcept { return levels_; }
  /// The last level that has a sample.
  int level_of(int sample) const noexcept { return level_[at(sample)]; }
  /// The level with about this spacing [m], not rounded; 0 to the last one.
  double level_with(double spacing) const noexcept;
  /// The spacing of a level [m]: of points on a plane, if each stands for the area of a hexagon.
  double spacing(double level) const noexcept { return finest_ * std::pow(2.0, 0.5 * level); }
  /// Area that a sample stands for at a level, also between two levels [m^2]; 0 where it has faded out.
  double area(int sample, double level) const noexcept;
  /// Outward normal at a sample: the mean of those of the triangles around it, weighted by their areas; unit.
  Vector3 normal(int sample) const noexcept { return normal_[at(sample)].cast<double>(); }

  /// Number of the first sample of a triangle, those of its last level first; those of triangle t end where those of
  /// t + 1 begin.
  int first_of(int t) const noexcept { return first_[at(t)]; }
  /// The sample of a level nearest to a sample of another surface whose vertices have the same numbers; -1 when its
  /// triangles no longer exist. Checks the triangles around a vertex; no allocation.
  int nearest(const ContactSurface& surface, const ContactSample& wanted, int level = 0) const noexcept;
  /// The sample at a vertex; -1 at a vertex without triangles. Checks the triangles around it; no allocation.
  int of_vertex(const ContactSurface& surface, int vertex) const noexcept;

 private:
  class Builder;  // what is needed only until the levels are known
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  double finest_ = 0.0;
  int levels_ = 1;
  std::vector<ContactSample> samples_;
  std::vector<Eigen::Vector3f> normal_;
  std::vector<std::uint8_t> level_;
  std::vector<int> first_area_;  // of every sample: its areas at levels 0 to its last one
  std::vector<float> area_;
  std::vector<int> first_;  // per triangle, one past the end last
};

/// Throws SetupError(bad_argument) when the longest edge is longer than a lattice with a spacing of one radius can
/// cover (ids: its vertices). The message states whether the edge is that long only because the scene's loads stretch
/// it.
void require_dense_points(const ContactSurface& surface, double radius);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/contact_samples.ipp>
#endif
