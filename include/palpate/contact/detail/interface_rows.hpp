// Rows of the contact between surfaces that deform: mortar gaps.
#pragma once

#include <palpate/contact/detail/bvh.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <compare>
#include <cstddef>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A surface that may touch others, as it is deformed at present, world frame.
struct InterfaceSurface {
  int body = 0;
  std::span<const Triangle> triangles{};
  std::span<const Vector3> positions{};
  const Bvh* bvh = nullptr;          ///< of the positions
  std::span<const double> depths{};  ///< per triangle: how deep another surface may have entered there [m]
  std::span<const Index> parts{};    ///< per triangle: parts that touch each other but not themselves; empty: one body
};

/// One vertex of one body in a row. Its displacement u changes the gap by weight * normal . u, and a force of the row
/// puts weight * normal * force on it.
struct InterfaceTerm {
  int body = 0, vertex = 0;
  double weight = 0.0;
};

/// What a row keeps out of the other surface: in the mean what is around a vertex, that vertex alone, or an edge.
enum class InterfacePart { mean, vertex, edge };

/// Which surfaces a row is between, and at which vertex or edge of the first one.
struct InterfaceKey {
  int body = 0, other = 0, vertex = 0;
  InterfacePart part = InterfacePart::mean;
  int end = -1;  ///< the other vertex of an edge
  friend bool operator==(const InterfaceKey&, const InterfaceKey&) = default;
  friend auto operator<=>(const InterfaceKey&, const InterfaceKey&) = default;
};

/// The gap between two surfaces around a vertex of one of them: the mean over what lies opposite, weighted with the
/// shape function of that vertex, along a mean of both normals in which a smooth surface counts more than an edge. The
/// weights of one body add up to -1, those of the other one to 1, so that the forces of a row are in equilibrium.
struct InterfaceRow {
  InterfaceKey key;
  Vector3 normal = Vector3::Zero();  ///< unit, outward at the first surface
  double area = 0.0;                 ///< that the row stands for [m^2]
  std::vector<InterfaceTerm> terms{};
};

/// Finds the rows between surfaces. Facets of one surface are projected onto the facets of another one along the
/// normals of these, and clipped: a uniform pressure passes exactly between meshes that do not match (mortar elements:
/// Puso and Laursen 2004). Of several layers that lie opposite, the nearest counts.
class InterfaceRows {
 public:
  /// Adds the rows at the vertices of `first` whose facets are not farther than `reach` [m] from those of `second`, nor
  /// deeper in it than both allow. For contact of a surface with itself both are the same surface: of two facets the
  /// one with the lower number has the rows, and facets that share a vertex or are of one part do not touch. Allocates.
  void add(const InterfaceSurface& first, const InterfaceSurface& second, double reach);
  void clear() noexcept { rows_.clear(); }
  std::vector<InterfaceRow>& rows() noexcept { return rows_; }

 private:
  using Point2 = std::array<double, 2>;
  struct Overlap {
    int triangle = -1;
    double gap = 0.0, area = 0.0;       // mean
    Vector3 normal = Vector3::Zero();   // of the other facet
    std::array<Point2, 3> projected{};  // corners of the other facet
    std::array<double, 3> heights{};    // of these corners above the facet
    std::array<Point2, 9> polygon{};
    int corners = 0;
  };
  /// What is added up for the row at a vertex of the first surface.
  struct Sum {
    Vector3 normal = Vector3::Zero(), opposite = Vector3::Zero();
    double area = 0.0, facets = 0.0;
    Vector3 direction() const noexcept;
    std::vector<InterfaceTerm> terms{};
    void add(int body, int vertex, double weight);
  };

  void find_overlaps(const InterfaceSurface& first, const InterfaceSurface& second, int t, double reach);
  void keep_nearest(double area);
  void integrate(const InterfaceSurface& first, const InterfaceSurface& second, int t, const Overlap& overlap);
  void finish(const InterfaceSurface& first, const InterfaceSurface& second);

  std::vector<InterfaceRow> rows_;
  std::vector<Overlap> overlaps_;
  std::vector<Sum> sums_;  // per vertex of the first surface; without terms between two calls
  std::vector<int> touched_;
  std::array<Vector3, 3> corner_{};
  Vector3 axis_[2], normal_;
};

/// How deep another surface may enter each facet: half of the distance to the opposite side of the body. Beyond it the
/// other surface may be on that side. `boundary` are the triangles of the whole body if they are known. O(n log n).
std::vector<double> interface_depths(std::span<const Triangle> triangles, std::span<const Vector3> positions,
                                     std::span<const Triangle> boundary, std::span<const Vector3> of_boundary,
                                     const Bvh& bvh);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/interface_rows.ipp>
#endif
