// Several tissues in one scene, touched by the same tools.
#pragma once

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/tissue_view.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Whether all hooks except prefetch do nothing.
template <class T>
concept HooksOnlyPrefetch = requires(T& tissue, std::span<const VertexForce> forces, std::span<const PointForce> points,
                                     ContactProblem& problem, const ToolRadii& radii,
                                     const ContactParameters& parameters, const BladeSweep& sweep) {
  { tissue.begin_tick() } -> std::same_as<NoHook>;
  { tissue.end_tick(forces, points) } -> std::same_as<NoHook>;
  { tissue.updates() } -> std::same_as<NoHook>;
  { tissue.exchange_contacts(problem) } -> std::same_as<NoHook>;
  { tissue.prepare_tools(radii, parameters) } -> std::same_as<NoHook>;
  { tissue.try_cut(sweep) } -> std::same_as<NoHook>;
};

}  // namespace detail

/// Tissues of any types that do not move by themselves, and have no hook but prefetch, as one TissueModel: a sphere
/// that touches two organs is one contact problem, with one force and one gate. Vertices are those of the members in
/// sequence. The frame is that of the first member at construction; a group of one gives the forces, flags and errors
/// of its member to the last bit. Refers to the members, which must outlive it; the organs do not touch each other.
class TissueGroup : public StillTissue {
 public:
  /// Throws bad_argument when there are no members. Allocates.
  template <class... T>
  requires(sizeof...(T) > 0) explicit TissueGroup(T&... members) { (add(checked(members)), ...), build(); }
  /// The same for a number of members known at run time.
  template <class T>
  explicit TissueGroup(std::span<T* const> members) {
    for (T* member : members) add(checked(*member));
    build();
  }

  /// Applies loads and poses that the members received since the last update. No allocation; not while a tick runs.
  void update() noexcept;

  /// Those of the group's forces that act on one member, in its own numbers and frame, as `displacement_with` takes
  /// them. Writes as many as fit and returns their number. No allocation.
  std::size_t forces_on(int member, std::span<const VertexForce> forces, std::span<VertexForce> own) const noexcept;

  /// Those of all members.
  std::vector<std::string> notes() const;
  /// Whether one of them does.
  bool refuses_suspicious_units() const noexcept;

  // TissueModel
  const ContactSurface& contact_surface() const noexcept { return surface_; }
  Status require_columns(std::span<const int> vertices) noexcept;
  void prefetch(std::span<const int> vertices) noexcept;
  Matrix3 compliance(int i, int j) const noexcept;
  Vector3 displacement_of(int i, std::span<const VertexForce> forces) const noexcept;
  double compliance_bound(int j) const noexcept;
  std::uint64_t compliance_revision() const noexcept;
  double compliance_floor() const noexcept { return floor_; }
  Matrix3 half_space_map(int v) const noexcept;
  const Eigen::Isometry3d& to_world() const noexcept { return world_; }

 private:
  struct Member {
    TissueView tissue;
    int first, count;         // vertices in the group
    Eigen::Isometry3d place;  // in the frame of the group
    bool in_place;            // that is the identity: nothing is rounded

    Vector3 placed(const Vector3& x) const noexcept;
    bool has(int vertex) const noexcept { return vertex >= first && vertex < first + count; }
  };

  template <class T>
  static TissueView checked(T& tissue) {
    static_assert(
        !AnnouncesChanges<T>,
        "palpate: a tissue that moves by itself cannot be in a TissueGroup; use a separate HapticServo for it");
    const TissueView view(tissue);
    if constexpr (TissueModel<T> && !AnnouncesChanges<T>)
      static_assert(detail::HooksOnlyPrefetch<T>,
                    "palpate: a TissueGroup forwards no hook but prefetch; use a separate HapticServo for a tissue "
                    "with other hooks");
    return view;
  }
  void add(const TissueView& tissue);
  void place(Member& m) const noexcept;
  void build();
  void add_shells();
  std::vector<ContactMaterial> materials() const;
  /// Of all members, in the frame of the group; empty if it is not set for one of them.
  ContactSurface::Unloaded unloaded() const;
  void join_errors();
  std::shared_ptr<const SubfacetCompliance> joined_subfacet() const;
  const Member& member_of(int vertex) const noexcept;
  std::span<const int> part_of(const Member& m, std::span<const int> vertices) noexcept;
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }

  std::vector<Member> members_;
  std::vector<Vector3> moved_;  // vertices of all members, then those of their shells
  std::vector<Triangle> triangles_;
  std::vector<int> own_;             // workspace
  std::vector<KnownErrors> errors_;  // of the members' bodies, in the numbers of the group
  ContactSurface surface_;
  double floor_ = infinity;
  std::uint64_t updates_ = 0;
  Eigen::Isometry3d world_ = Eigen::Isometry3d::Identity();
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/tissue_group.ipp>
#endif
