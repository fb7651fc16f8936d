// The touchable surface as the contact code uses it, and which of its facets are too long for a tool.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/contact/force_accuracy.hpp>

#include <algorithm>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A surface as forces of a known time deform it. A tissue that moves knows it; the forces of the next ticks differ
/// little from those, so that a search around these positions is as wide as the surface moves between two updates, and
/// not as deep as the tools press. It is a place to start from, not an assumption: a search adds how far the loaded
/// vertices have moved away from it.
class ExpectedSurface {
 public:
  /// Without vertices: nothing is expected.
  ExpectedSurface() = default;

  bool is_known() const noexcept { return !positions_.empty(); }
  const Vector3& position(int v) const noexcept { return positions_[static_cast<std::size_t>(v)]; }
  const detail::Bvh& bvh() const noexcept { return bvh_; }
  /// The vertices with forces.
  std::span<const int> loaded() const noexcept { return {loaded_.data(), count_}; }

  /// Sets positions and forces. `resting`: of the same triangles. Allocates at the first call and when there are more
  /// vertices than before. O(vertices + triangles).
  void set(const detail::Bvh& resting, std::span<const Triangle> triangles, std::span<const Vector3> positions,
           std::span<const VertexForce> forces);

 private:
  std::vector<Vector3> positions_;
  detail::Bvh bvh_;
  std::vector<int> loaded_;  // the first count_
  std::size_t count_ = 0;
};

class SubfacetCompliance;

/// The isotropic material behind a triangle.
struct ContactMaterial {
  double modulus = 0.0;        ///< contact modulus E / (1 - nu^2) [Pa]; 0 is unknown
  double poisson_ratio = 0.0;  ///< nu
};

/// Vertices and outward triangles of the touchable surface, at rest under its loads and without tools.
class ContactSurface {
 public:
  ContactSurface() = default;

  /// Allocates; for set-up.
  ContactSurface(std::vector<Vector3> positions, std::vector<Triangle> triangles);

  const std::vector<Vector3>& positions() const noexcept { return positions_; }
  const std::vector<Triangle>& triangles() const noexcept { return triangles_; }
  const Vector3& position(int v) const noexcept { return positions_[static_cast<std::size_t>(v)]; }
  const Triangle& triangle(int t) const noexcept { return triangles_[static_cast<std::size_t>(t)]; }
  /// Unit outward normal of a triangle.
  const Vector3& normal(int t) const noexcept { return normals_[static_cast<std::size_t>(t)]; }
  const detail::Bvh& bvh() const noexcept { return bvh_; }
  /// Numbers of the triangles at a vertex.
  std::span<const int> triangles_at(int v) const noexcept {
    const auto i = static_cast<std::size_t>(v);
    return {triangles_at_.data() + first_at_[i], static_cast<std::size_t>(first_at_[i + 1] - first_at_[i])};
  }
  /// Changes whenever the resting surface moves.
  std::uint64_t revision() const noexcept { return revision_; }
  /// Number of edges with more than two triangles, where bodies or sheets meet.
  int crowded_edges() const noexcept { return crowded_edges_; }
  int vertex_count() const noexcept { return static_cast<int>(positions_.size()); }

  /// The surface without loads, so that an error message can state how far the loads have deformed it.
  struct Unloaded {
    std::vector<Vector3> positions;  ///< of the vertices; empty if not set
    std::string loads;               ///< as text: "gravity of 9.81 m/s^2"
  };
  void set_unloaded(Unloaded unloaded) { unloaded_ = std::move(unloaded); }
  void set_loads(std::string loads) noexcept { unloaded_.loads = std::move(loads); }
  const Unloaded& unloaded() const noexcept { return unloaded_; }

  /// Sets the isotropic material behind every triangle; an empty list is unknown. With it a sphere much smaller than a
  /// facet gets the indentation that the facet does not show; without it the contact of such a sphere is too stiff, and
  /// ticks report coarse_contact.
  void set_materials(std::vector<ContactMaterial> materials) noexcept { materials_ = std::move(materials); }
  ContactMaterial material(int t) const noexcept {
    return static_cast<std::size_t>(t) < materials_.size() ? materials_[static_cast<std::size_t>(t)]
                                                           : ContactMaterial{};
  }
  /// Sets the compliance of points finer than facets; null: points have that of the mesh.
  void set_subfacet(std::shared_ptr<const SubfacetCompliance> subfacet) noexcept { subfacet_ = std::move(subfacet); }
  const std::shared_ptr<const SubfacetCompliance>& subfacet() const noexcept { return subfacet_; }
  /// Whether the material below is stretched where tools press deep. Forces on points that are farther apart than the
  /// vertices would then invert elements.
  void set_large_strain(bool large) noexcept { large_strain_ = large; }
  bool has_large_strain() const noexcept { return large_strain_; }
  /// Whether the facets cannot bend, so that long ones are not coarse.
  void set_rigid(bool rigid) noexcept { rigid_ = rigid; }
  bool is_rigid() const noexcept { return rigid_; }
  /// Sets the errors that were measured on this surface; null: none were.
  void set_force_accuracy(std::shared_ptr<const ForceAccuracy> accuracy) noexcept { accuracy_ = std::move(accuracy); }
  /// Sets what is known about the other errors of a linear model.
  void set_model_error(detail::LinearModelError error) noexcept { model_error_ = std::move(error); }
  const ForceAccuracy* force_accuracy() const noexcept { return accuracy_.get(); }
  const std::shared_ptr<const ForceAccuracy>& shared_force_accuracy() const noexcept { return accuracy_; }
  const detail::LinearModelError& model_error() const noexcept { return model_error_; }
  /// sqrt(2 area): of half a square, the side of that square [m].
  double facet_length(int t) const noexcept;
  /// The square of twice the area of a facet: the fourth power of facet_length, without roots [m^4].
  double double_area_squared(int t) const noexcept {
    const Triangle& v = triangle(t);
    return cross(position(v[1]) - position(v[0]), position(v[2]) - position(v[0])).squaredNorm();
  }

  /// Moves the resting surface (new loads, new pose of the loads). With a shell, its positions follow those of the
  /// vertices; without them it stays. No allocation; not while a tick runs.
  void move_to(std::span<const Vector3> positions) noexcept { move_to(positions, revision_ + 1); }
  /// The same for one of several copies of a surface that take turns: `revision` is a number of this state only.
  void move_to(std::span<const Vector3> positions, std::uint64_t revision) noexcept;

  /// Sets where the vertices are under forces that act at present, for a tissue that moves: after every `move_to`.
  /// Ticks search for contacts near these positions; without them, around the resting surface as far as the forces may
  /// have moved it. Results are the same. Allocates at the first call; not while a tick runs.
  void expect(std::span<const Vector3> positions, std::span<const VertexForce> forces) {
    expected_.set(bvh_, triangles_, positions, forces);
  }
  const ExpectedSurface& expected() const noexcept { return expected_; }

  /// Adds the untouchable rest of the body's boundary, so that inside and outside are known beyond the touchable
  /// surface. An index v of a triangle is a vertex of this surface if v < vertex_count(), otherwise it means
  /// positions[v - vertex_count()] [m]. Allocates; for set-up.
  void add_shell(std::span<const Vector3> positions, const std::vector<Triangle>& triangles);

  /// The closest point of the resting surface: triangle, point, and signed distance (negative inside) by the
  /// angle-weighted pseudo-normal of the closest feature (Baerentzen and Aanaes 2005), or by the wedge in which the
  /// point lies where more than two triangles meet at an edge, or several fans of triangles at a vertex. Where the
  /// closest feature is on the rim of an open surface, the distance is positive.
  struct Closest {
    int triangle = -1;
    Vector3 point = Vector3::Zero();
    Vector3 outward = Vector3::Zero();  ///< unit, from the surface to free space
    double distance = infinity;
  };
  Closest closest(const Vector3& p) const noexcept;
  /// As closest, with the sign of the closed boundary if there is a shell. Where the shell is closer than the touchable
  /// surface, the result has no triangle and an infinite distance.
  Closest closest_of_body(const Vector3& p) const noexcept;
  bool has_shell() const noexcept { return !body_.empty(); }
  /// The shell as given to add_shell.
  std::span<const Vector3> shell_positions() const noexcept;
  std::span<const Triangle> shell() const noexcept;
  /// Signed distance of a point from the closed boundary, negative inside; without a shell, from the touchable surface,
  /// as `closest` has it [m].
  double distance_of_body(const Vector3& p) const noexcept;
  /// Whether a point is inside the closed boundary; without a shell, whether it is behind the touchable surface.
  bool is_inside(const Vector3& p) const noexcept { return distance_of_body(p) < 0.0; }
  /// The boundary that decides about inside and outside: with the shell if there is one.
  const ContactSurface& boundary() const noexcept { return body_.empty() ? *this : body_.front(); }
  /// Whether the boundary has no rim.
  bool is_closed() const noexcept { return !boundary().has_rim_; }
  /// Whether an edge or vertex of a triangle is on the rim of the touchable surface.
  bool is_rim(int t, detail::TriangleFeature feature) const noexcept;
  /// Whether a vertex is on the rim of the touchable surface.
  bool is_rim_vertex(int v) const noexcept { return vertex_kind_[static_cast<std::size_t>(v)] == VertexKind::rim; }
  /// Whether the shell goes on at a vertex of the rim, with a facet within 60 degrees of a unit direction: a tool there
  /// would press facets that it cannot touch.
  bool goes_on(int v, const Vector3& direction) const noexcept;

 private:
  inline detail::TrianglePoint closest_on(int t, const Vector3& p) const noexcept;
  inline Vector3 point_on(int t, const detail::TrianglePoint& on) const noexcept;
  Vector3 feature_normal(int t, detail::TriangleFeature feature) const noexcept;
  bool is_outside(int t, detail::TriangleFeature feature, const Vector3& offset) const noexcept;
  void list_triangles();
  void list_neighbours();
  bool is_one_fan(int v) const;
  void update_normals() noexcept;

  std::vector<Vector3> positions_;
  std::vector<Triangle> triangles_;
  detail::Bvh bvh_;
  std::vector<Vector3> normals_, vertex_normals_;
  enum class VertexKind : std::uint8_t { regular, rim, crowded };  // crowded: not one fan of triangles
  std::vector<VertexKind> vertex_kind_;
  std::vector<int> first_at_, triangles_at_;  // triangles of every vertex
  int crowded_edges_ = 0;
  bool has_rim_ = false;
  std::uint64_t revision_ = 0;
  ExpectedSurface expected_;
  std::vector<ContactSurface> body_;  // with the shell; none or one
  Unloaded unloaded_;
  bool large_strain_ = false, rigid_ = false;
  std::vector<ContactMaterial> materials_;  // per triangle, or empty
  std::shared_ptr<const SubfacetCompliance> subfacet_;
  std::shared_ptr<const ForceAccuracy> accuracy_;
  detail::LinearModelError model_error_;
  std::vector<std::array<int, 3>> neighbour_;  // across edges 01, 12, 20, or one of these:
  static constexpr int no_neighbour = -1, several_neighbours = -2;
};

/// Facets that do not show the dent of a sphere of this radius. Where the half-space is known, contact points have the
/// dent that is missing (SubfacetCompliance); elsewhere the contact is too stiff. docs/contact.md.
struct CoarseFacetReport {
  double radius = 0.0;         ///< of the smallest tool [m]
  double longest = 0.0;        ///< largest ContactSurface::facet_length [m]
  std::vector<int> triangles;  ///< numbers of the triangles that are too long, ascending
  int unknown_materials = 0;   ///< how many of them have no known material
};

namespace detail {

/// Checks every triangle once. Allocates; for set-up.
CoarseFacetReport report_coarse_facets(const ContactSurface& surface, double radius);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/contact_surface.ipp>
#endif
