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
/// to one triangle.
class ContactSamples {
 public:
  ContactSamples() = default;

  /// Largest number of parts of an edge: limits the lattice on very coarse triangles, and with it the work of a tick.
  static constexpr int maximum_subdivision = 32;

  /// Allocates; for set-up.
  ContactSamples(const ContactSurface& surface, double spacing);

  /// The samples that belong to a triangle.
  std::span<const ContactSample> of_triangle(int t) const noexcept {
    const auto i = static_cast<std::size_t>(t);
    return {samples_.data() + first_[i], static_cast<std::size_t>(first_[i + 1] - first_[i])};
  }
  int count() const noexcept { return static_cast<int>(samples_.size()); }
  const ContactSample& operator[](int sample) const noexcept { return samples_[static_cast<std::size_t>(sample)]; }
  /// The sample nearest to a sample of another surface whose vertices have the same numbers; -1 when its triangles no
  /// longer exist. Checks the triangles around a vertex; no allocation.
  int nearest(const ContactSurface& surface, const ContactSample& wanted) const noexcept;
  /// Number of the first sample of a triangle; those of triangle t end where those of t + 1 begin.
  int first_of(int t) const noexcept { return first_[static_cast<std::size_t>(t)]; }

 private:
  void add_edge(const ContactSurface& surface, int number, std::size_t i, double spacing);

  std::vector<ContactSample> samples_;
  std::vector<int> first_;  // per triangle, one past the end last
};

/// Throws SetupError(bad_argument) when the longest edge is longer than a lattice with a spacing of one radius can
/// cover (ids: its vertices). The message states whether the edge is that long only because the scene's loads stretch
/// it.
void require_dense_points(const ContactSurface& surface, double radius);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/contact_samples.ipp>
#endif
