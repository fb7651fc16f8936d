// Displacement of the vertices of the contact surface under the forces of the tools.
#pragma once

#include <palpate/contact/detail/half_space.hpp>
#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/contact/tissue_view.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A force on a point of the surface.
struct PointLoad {
  int sample = -1;
  HalfSpacePoint point;
  double area = 0.0;                ///< that the point stands for [m^2]
  Vector3 moved = Vector3::Zero();  ///< displacement of the point [m]
  Vector3 force = Vector3::Zero();  ///< [N], in the axes of the SubfacetCompliance
  double magnitude = 0.0;           ///< of the force [N]; set by `add_load`
};

/// Forces on vertices, and the displacement of any vertex under them, computed on request and cached until the forces
/// change. The displacement of points within facets needs the forces on points, too.
class SurfaceDisplacement {
 public:
  /// Allocates for a surface and for `capacity` loaded vertices; for set-up. `number`: 0 or 1, other than that of a
  /// second object whose generations must be different.
  SurfaceDisplacement(int vertices, int capacity, int number = 0);
  /// Changes whenever displacements may change.
  std::uint64_t generation() const noexcept { return generation_; }

  std::span<const VertexForce> forces() const noexcept { return {forces_.data(), static_cast<std::size_t>(count_)}; }

  /// Clears cached displacements when the tissue's compliance has changed since the last tick.
  void begin_tick(std::uint64_t revision) noexcept;
  /// Continues on a surface with the same vertex numbers and possibly more or fewer, for which `fresh` was constructed.
  /// Forces on vertices that are gone are dropped; loads need `renumber_loads` before anything else. No allocation.
  void move_to(SurfaceDisplacement& fresh) noexcept;
  /// Clears cached displacements: points have another compliance.
  void forget() noexcept { generation_ += 2; }
  void clear() noexcept {
    count_ = load_count_ = 0;
    change_loads();
  }
  /// Back to the state after construction. The dents before a step limit the search after it.
  void reset() noexcept {
    clear();
    largest_dent_ = dent_before_ = 0.0;
  }
  /// Adds a force on a vertex; `slot` stores its entry between calls (initially -1).
  void add(int vertex, const Vector3& force, int& slot) noexcept;

  /// Adds a force on a point that is known in a SubfacetCompliance, whose parts were added to its vertices.
  void add_load(const PointLoad& load, const ContactSample& sample) noexcept;

  /// `renumber` changes the point of a load for the present surface, and returns whether it still exists there.
  template <class Renumber>
  void renumber_loads(const ContactSamples& samples, Renumber&& renumber) noexcept {
    const auto all = static_cast<std::size_t>(std::exchange(load_count_, 0));
    for (std::size_t i = 0; i < all; ++i)
      if (PointLoad load = loads_[i]; renumber(load)) add_load(load, samples[load.sample]);
  }

  bool has_loads() const noexcept { return load_count_ > 0; }

  /// Takes `part` of these forces and 1 - `part` of those of `before`. Forces beyond the capacity are dropped.
  void blend(const TissueView& tissue, SurfaceDisplacement& before, double part, const SubfacetCompliance* subfacet,
             const ContactSamples& samples) noexcept;

  /// Displacement of a vertex under the forces [m].
  const Vector3& at(const TissueView& tissue, int vertex) noexcept {
    const auto i = static_cast<std::size_t>(vertex);
    if (stamp_[i] != generation_) {
      stamp_[i] = generation_;
      tissue.displacement(vertex, forces(), displacement_[i]);
    }
    return displacement_[i];
  }
  /// Displacement of a known point: that of the mesh without what it shows of the half-space, and that of the
  /// half-space [m]. O(loads).
  Vector3 at_point(const TissueView& tissue, const SubfacetCompliance& subfacet, const ContactSample& sample,
                   const HalfSpacePoint& point, int number) noexcept;
  /// The part of `at_point` without the displacement of the half-space [m]. An interpolation of values of the three
  /// vertices: O(1) once they are known.
  Vector3 without_half_space(const TissueView& tissue, const SubfacetCompliance& subfacet,
                             const ContactSample& sample) noexcept;
  /// What the mesh shows of the half-space at a vertex under the loads [m]. O(1) once it is known.
  const Vector3& shown(const SubfacetCompliance& subfacet, int vertex) noexcept {
    const auto i = static_cast<std::size_t>(vertex);
    if (shown_stamp_[i] != load_generation_) compute_shown(subfacet, vertex);
    return shown_[i];
  }
  /// How far outward the half-space may move a point with this normal at rest from there [m]. Loads that press on a
  /// surface that faces as the point does move it inward: a tenth of the largest dent is allowed, for what loads along
  /// the surface move beside them. Where loads pull, are more along the surface than into it, or press walls that face
  /// elsewhere, it may be as far as the half-space moves a loaded point. O(loads) after the forces have changed, O(1)
  /// otherwise.
  double largest_bulge(const TissueView& tissue, const SubfacetCompliance& subfacet, const ContactSamples& samples,
                       const Vector3& normal) noexcept {
    measure_dents(tissue, subfacet, samples);
    return only_presses_ && normal.dot(pressed_normal_) > aligned ? 0.1 * largest_dent_ : largest_half_space_;
  }
  /// Deformed position of a vertex [m].
  Vector3 position(const TissueView& tissue, int vertex) noexcept;

  /// The same with the dent of the half-space, where `subfacet` is not null and the vertex is known [m]. O(loads) once
  /// after the forces have changed.
  Vector3 dented_position(const TissueView& tissue, const SubfacetCompliance* subfacet, int vertex) noexcept;

  /// Distance of a vertex from where the surface is expected, or else from its place at rest [m].
  double deviation(const TissueView& tissue, int vertex) noexcept;
  /// Displacement of the surface near the forces [m]: the smaller of a bound that is valid everywhere and twice the
  /// largest displacement of the loaded vertices. The latter is no bound for a part that rotates about another;
  /// `Candidates` searches for such parts.
  double reach(const TissueView& tissue) noexcept;
  /// The same for distances from where the surface is expected; the vertices whose forces are expected count, too. The
  /// half-space moves points between vertices: `subfacet` is null where there is none.
  double reach_from_expected(const TissueView& tissue, const SubfacetCompliance* subfacet,
                             const ContactSamples& samples) noexcept;
  /// Of the points with loads [m].
  double longest_path() const noexcept;

 private:
  void change_loads() noexcept {
    generation_ += 2;
    ++load_generation_;
  }
  static constexpr double aligned = 0.5;  // cosine of 60 degrees
  void measure_dents(const TissueView& tissue, const SubfacetCompliance& subfacet,
                     const ContactSamples& samples) noexcept;
  void blend_loads(const SurfaceDisplacement& before, double part, const ContactSamples& samples) noexcept;
  void compute_shown(const SubfacetCompliance& subfacet, int vertex) noexcept;
  /// Displacement of the mesh at a point [m].
  inline Vector3 of_mesh(const TissueView& tissue, const ContactSample& sample) noexcept;
  /// Displacement of the half-space at a known point [m], not rotated. `number`: of its sample; -1 where it is not
  /// known. O(loads).
  Vector3 of_half_space(const SubfacetCompliance& subfacet, const HalfSpacePoint& point, int number) noexcept;

  std::vector<VertexForce> forces_;
  std::vector<PointLoad> loads_;
  HalfSpaceLoads half_space_;  // the same loads
  int count_ = 0, load_count_ = 0;
  std::vector<int> sample_;              // of the loads
  std::vector<Vector3> shown_, loaded_;  // loaded: the parts of the loads on a vertex
  std::vector<std::uint64_t> shown_stamp_, loaded_stamp_;
  std::vector<Vector3> displacement_, dented_;
  std::vector<std::uint64_t> stamp_, dented_stamp_;
  std::vector<int> slot_;  // of a vertex's force; -1 between calls
  std::uint64_t generation_ = 2, revision_ = 0, dent_stamp_ = 0;
  std::uint64_t load_generation_ = 1;  // of what depends on the loads only, not on the tissue's compliance
  // Of loaded points: the largest difference from where the vertices alone put them, and what the half-space moves them
  // at most [m]; the mean of their normals at rest; whether all loads press, on surfaces that face about as that mean.
  double largest_dent_ = 0.0, largest_half_space_ = 0.0;
  double dent_before_ = 0.0;  // largest_dent_ of the measurement before
  Vector3 pressed_normal_ = Vector3::Zero();
  bool only_presses_ = false;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/surface_displacement.ipp>
#endif
