// Finds the element that contains a point, and the reference coordinates of the point in it.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/box.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The mean of an element's reference nodes.
template <Element E>
Vector3 reference_centre() noexcept {
  const ElementNodes<E> nodes = E::reference_nodes();
  Vector3 sum = Vector3::Zero();
  for (int a = 0; a < E::nodes; ++a)
    for (int c = 0; c < 3; ++c) sum[c] += nodes(a, c);
  return sum / static_cast<double>(E::nodes);
}

/// Reference coordinates of the point p [m] with respect to the element with nodes x, also for points outside the
/// element, by Newton's method. std::nullopt if it does not converge, as for a point far away from a curved element.
template <Element E>
std::optional<Vector3> reference_coordinates(const ElementNodes<E>& x, const Vector3& p) noexcept {
  const Vector3 origin(x(0, 0), x(0, 1), x(0, 2)), target = p - origin;
  const auto edge = [&](int a) -> Vector3 { return Vector3(x(a, 0), x(a, 1), x(a, 2)) - origin; };
  const auto miss_at = [&](const Vector3& xi) {
    const auto shape = E::shape(xi);
    Vector3 miss = target;
    for (int a = 1; a < E::nodes; ++a) miss -= shape[a] * edge(a);
    return miss;
  };
  const auto jacobian_at = [&](const Vector3& xi) {
    const auto gradient = E::gradient(xi);
    Matrix3 jacobian = Matrix3::Zero();
    for (int a = 1; a < E::nodes; ++a)
      for (int c = 0; c < 3; ++c)
        for (int i = 0; i < 3; ++i) jacobian(i, c) += edge(a)[i] * gradient(a, c);
    return jacobian;
  };
  double size = 0.0;
  for (int a = 1; a < E::nodes; ++a) size = std::max(size, edge(a).norm());
  Vector3 xi = reference_centre<E>();
  for (int iteration = 0; iteration < 25; ++iteration) {
    const Vector3 miss = miss_at(xi);
    if (miss.norm() <= 1e-12 * size) return xi;
    xi += inverse(jacobian_at(xi)) * miss;
    if (!(std::abs(xi[0]) < 1e3 && std::abs(xi[1]) < 1e3 && std::abs(xi[2]) < 1e3)) return std::nullopt;
  }
  return miss_at(xi).norm() <= 1e-9 * size ? std::optional<Vector3>(xi) : std::nullopt;
}

/// Signed distance of reference coordinates outside the faces of the reference element; negative inside.
template <Element E>
double beyond_faces(const Vector3& xi) noexcept {
  static const auto planes = [] {
    std::array<std::pair<Vector3, double>, E::faces.size()> all;  // outward normal, offset
    const ElementNodes<E> x = E::reference_nodes();
    for (std::size_t f = 0; f < all.size(); ++f) {
      const auto node = [&](std::size_t a) {
        const auto n = E::faces[f][a];
        return Vector3(x(n, 0), x(n, 1), x(n, 2));
      };
      const Vector3 normal = cross(node(1) - node(0), node(2) - node(0)).normalized();
      all[f] = {normal, normal.dot(node(0))};
    }
    return all;
  }();
  double most = -infinity;
  for (const auto& [normal, offset] : planes) most = std::max(most, normal.dot(xi) - offset);
  return most;
}

/// A point in a mesh: an element and reference coordinates in it.
struct ElementPoint {
  Index element = -1;
  Vector3 xi = Vector3::Zero();
};

/// Finds points in a mesh with a grid over the bounding boxes of its elements. Keeps a reference to the mesh.
template <Element E>
class ElementSearch {
 public:
  /// O(elements), allocates about 8 bytes per pair of an element and a cell that its box touches.
  explicit ElementSearch(const Mesh<E>& mesh) : mesh_(&mesh) {
    const Box box = box_of(mesh.positions);
    low_ = box.low;
    const Vector3 size = box.size();
    const double volume = std::max(size[0] * size[1] * size[2], 1e-300),
                 count = static_cast<double>(mesh.element_count());
    const double cell = std::max(std::cbrt(volume / std::max(1.0, count)), 1e-3 * max_abs(size));
    per_metre_ = 1.0 / cell;
    for (std::size_t i = 0; i < 3; ++i) cells_[i] = 1 + static_cast<Index>(size[static_cast<int>(i)] * per_metre_);
    start_.assign(static_cast<std::size_t>(cells_[0] * cells_[1] * cells_[2]) + 1, 0);
    each_cell([&](std::size_t c, Index) { ++start_[c + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    element_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    each_cell([&](std::size_t c, Index e) { element_[static_cast<std::size_t>(next[c]++)] = e; });
  }

  /// The element that contains p [m], its boundary included; the first of several. No allocation. Cost: Newton's method
  /// for the elements around one cell of the grid, one step each for straight-sided tetrahedra. A cell has the mean
  /// volume of an element, so these are a few tens in a uniform mesh, and O(elements) in the worst case, if sizes
  /// differ so much that most elements are in one cell.
  std::optional<ElementPoint> find(const Vector3& p) const noexcept {
    const Cell at = cell_of(p);
    for (std::size_t i = 0; i < 3; ++i)
      if (at[i] < 0 || at[i] >= cells_[i]) return std::nullopt;
    const std::size_t c = number(at);
    for (Index i = start_[c]; i < start_[c + 1]; ++i) {
      const Index e = element_[static_cast<std::size_t>(i)];
      const auto xi = reference_coordinates<E>(element_nodes<E>(*mesh_, e), p);
      if (xi && beyond_faces<E>(*xi) <= 1e-9) return ElementPoint{e, *xi};
    }
    return std::nullopt;
  }

 private:
  using Cell = std::array<Index, 3>;

  Cell cell_of(const Vector3& p) const noexcept {
    const Vector3 scaled = per_metre_ * (p - low_);
    const auto along = [&](int i) { return static_cast<Index>(std::floor(std::min(1e15, std::max(-1.0, scaled[i])))); };
    return {along(0), along(1), along(2)};
  }
  std::size_t number(const Cell& c) const noexcept {
    return static_cast<std::size_t>(c[0] + cells_[0] * (c[1] + cells_[1] * c[2]));
  }
  /// Calls visit(cell, element) for all cells that the box of an element touches. The box is slightly enlarged for
  /// curved sides and for points on a boundary.
  template <class Visit>
  void each_cell(Visit&& visit) const {
    for (Index e = 0; e < mesh_->element_count(); ++e) {
      Box box;
      for (int a = 0; a < E::nodes; ++a) box.include(mesh_->position(Index{mesh_->element_node(e, a)}));
      const double wider = (E::order > 1 ? 0.1 : 1e-6) * max_abs(box.size());
      const Vector3 margin(wider, wider, wider);
      Cell first = cell_of(box.low - margin), last = cell_of(box.high + margin);
      for (std::size_t i = 0; i < 3; ++i) {
        first[i] = std::max(first[i], Index{0});
        last[i] = std::min(last[i], cells_[i] - 1);
      }
      for (Index k = first[2]; k <= last[2]; ++k)
        for (Index j = first[1]; j <= last[1]; ++j)
          for (Index i = first[0]; i <= last[0]; ++i) visit(number({i, j, k}), e);
    }
  }

  const Mesh<E>* mesh_;
  Vector3 low_ = Vector3::Zero();
  double per_metre_ = 1.0;
  Cell cells_{1, 1, 1};
  std::vector<Index> start_, element_;
};

}}}  // namespace palpate::detail
