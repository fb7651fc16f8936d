// The convex hull of a few points, and its closest point to any point.
#pragma once

#include <palpate/contact/detail/triangle.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class ContactSurface;
struct ContactTool;

namespace detail {

/// The functions that place a convex tool next to the surface (hull_placement.hpp). Its hull carries them, so that only
/// programs that make a ConvexTool have their code.
struct HullPlacement {
  void (*beside)(ContactTool&, const ContactSurface&) noexcept;
  double (*first_touch)(const ContactTool&, const ContactSurface&, const Vector3& from,
                        const Vector3& position) noexcept;
};

}  // namespace detail

/// A point, a segment, a plane convex polygon or a convex polyhedron: the convex hull of 1 to 64 points. Constant after
/// construction; queries do not allocate.
class ConvexHull {
 public:
  static constexpr std::size_t maximum_points = 64;
  static constexpr std::size_t maximum_faces = 2 * maximum_points - 4;

  /// Points inside the hull, and within 1e-9 of its size of its faces and edges, are no vertices. A hull thinner than
  /// 1e-6 of its length is a plane polygon, or a segment. Throws bad_argument for no or more than 64 points, points
  /// that are not finite, and features smaller than a millionth of the hull. Allocates; for set-up.
  explicit ConvexHull(std::span<const Vector3> points);

  /// 0: a point, 1: a segment, 2: a plane polygon, 3: a polyhedron.
  int dimension() const noexcept { return dimension_; }
  std::span<const Vector3> vertices() const noexcept { return vertices_; }
  /// Outward triangles of its faces, for drawing; of a plane polygon both sides.
  std::span<const Triangle> triangles() const noexcept { return triangles_; }

  /// Centre of a sphere that contains the hull, inside the hull.
  const Vector3& middle() const noexcept { return middle_; }
  /// Radius of that sphere [m].
  double radius() const noexcept { return radius_; }
  /// Largest distance of a vertex from the origin [m].
  double extent() const noexcept { return extent_; }
  /// The middle, then up to eight vertices far from each other.
  std::span<const Vector3> probes() const noexcept { return probes_; }

  struct Closest {
    Vector3 point = Vector3::Zero();
    Vector3 outward = Vector3::Zero();  ///< unit, from the hull to free space
    double distance = 0.0;              ///< [m], negative inside a polyhedron
  };
  /// The closest point of the boundary. Outside it is in the face whose plane is farthest below `p`, or else on an edge
  /// of a visible face; inside it is in the nearest face. The signed distance is convex. Exact; work bounded by the
  /// number of faces and edges (12 and 6 for a box).
  Closest closest(const Vector3& p) const noexcept { return closest_(*this, p); }

  /// For servos: null unless it is the hull of a ConvexTool.
  const detail::HullPlacement* placement() const noexcept { return placement_; }

 private:
  friend class ConvexTool;
  struct Face {
    Vector3 normal;  // unit, outward
    double offset;   // of its plane along the normal
    int first, end;  // of sides_
    double height(const Vector3& p) const noexcept { return normal.dot(p) - offset; }
  };
  struct Side {  // of a face, in its plane
    Vector3 outward;
    double offset;
    double height(const Vector3& p) const noexcept { return outward.dot(p) - offset; }
  };
  struct Edge {
    Vector3 start, along;
    double inverse_square;     // of its length; 0 for a point
    std::array<int, 2> faces;  // -1: none
  };

  void add_face(std::span<const int> corners);
  void add_edges(const std::vector<std::vector<int>>& faces);
  void bound();
  static Closest find_closest(const ConvexHull& hull, const Vector3& p) noexcept;
  inline bool covers(const Face& face, const Vector3& p) const noexcept;

  int dimension_ = 0;
  std::vector<Vector3> vertices_, probes_;
  std::vector<Triangle> triangles_;
  std::vector<Face> faces_;
  std::vector<Side> sides_;
  std::vector<Edge> edges_;
  Vector3 middle_ = Vector3::Zero();
  double radius_ = 0.0, extent_ = 0.0;
  /// A pointer set by the constructor: a program that makes no hull has no code of it.
  Closest (*closest_)(const ConvexHull&, const Vector3&) noexcept;
  const detail::HullPlacement* placement_ = nullptr;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/convex_hull.ipp>
#endif
