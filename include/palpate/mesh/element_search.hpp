// Which element a point lies in, and where in it.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>

#include <Eigen/Geometry>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <optional>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Reference coordinates of the point p [m] in the element with nodes x, or beyond it, by Newton's method. Nothing when
/// there are none to be found: a point far off a curved element.
template <Element E>
std::optional<Vector3> reference_coordinates(const ElementNodes<E>& x, const Vector3& p) noexcept {
  const ElementNodes<E> edges = x.rowwise() - x.row(0);
  const Vector3 target = p - x.row(0).transpose();
  const double size = edges.rowwise().norm().maxCoeff();
  Vector3 xi = E::reference_nodes().colwise().mean().transpose();
  for (int iteration = 0; iteration < 25; ++iteration) {
    const Vector3 miss = target - edges.transpose() * E::shape(xi);
    if (miss.norm() <= 1e-12 * size) return xi;
    const Matrix3 jacobian = edges.transpose() * E::gradient(xi);
    xi += jacobian.inverse() * miss;
    if (!(xi.cwiseAbs().maxCoeff() < 1e3)) return std::nullopt;
  }
  const Vector3 miss = target - edges.transpose() * E::shape(xi);
  return miss.norm() <= 1e-9 * size ? std::optional<Vector3>(xi) : std::nullopt;
}

/// How far reference coordinates lie beyond the faces of the reference element; negative inside.
template <Element E>
double beyond_faces(const Vector3& xi) noexcept {
  static const auto planes = [] {
    std::array<std::pair<Vector3, double>, E::faces.size()> all;  // outward normal, offset
    const ElementNodes<E> x = E::reference_nodes();
    for (std::size_t f = 0; f < all.size(); ++f) {
      const auto node = [&](std::size_t a) -> Vector3 { return x.row(E::faces[f][a]).transpose(); };
      const Vector3 normal = (node(1) - node(0)).cross(node(2) - node(0)).normalized();
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

/// Finds points in a mesh by a grid over the boxes of its elements. Refers to the mesh.
template <Element E>
class ElementSearch {
 public:
  /// O(elements), allocates about 8 bytes per element and cell it touches.
  explicit ElementSearch(const Mesh<E>& mesh) : mesh_(&mesh) {
    Eigen::AlignedBox3d box;
    for (const Vector3& x : mesh.positions) box.extend(x);
    low_ = box.min();
    const double volume = std::max(box.sizes().prod(), 1e-300), count = static_cast<double>(mesh.element_count());
    const double cell = std::max(std::cbrt(volume / std::max(1.0, count)), 1e-3 * box.sizes().maxCoeff());
    per_metre_ = 1.0 / cell;
    for (int i = 0; i < 3; ++i) cells_[i] = 1 + static_cast<Index>(box.sizes()[i] * per_metre_);
    start_.assign(static_cast<std::size_t>(cells_.prod()) + 1, 0);
    each_cell([&](std::size_t c, Index) { ++start_[c + 1]; });
    std::partial_sum(start_.begin(), start_.end(), start_.begin());
    element_.resize(static_cast<std::size_t>(start_.back()));
    std::vector<Index> next(start_.begin(), start_.end() - 1);
    each_cell([&](std::size_t c, Index e) { element_[static_cast<std::size_t>(next[c]++)] = e; });
  }

  /// The element that holds p [m], its border included; the first of several. No allocation. Cost: Newton's method for
  /// the elements around one cell of the grid, one step each for straight-sided tetrahedra. A cell has the
  /// mean volume of an element, so these are a few tens in an even mesh, and O(elements) at worst, where sizes differ
  /// so much that most elements lie in one cell.
  std::optional<ElementPoint> find(const Vector3& p) const noexcept {
    const auto at = cell_of(p);
    if ((at.array() < 0).any() || (at.array() >= cells_.array()).any()) return std::nullopt;
    const std::size_t c = number(at);
    for (Index i = start_[c]; i < start_[c + 1]; ++i) {
      const Index e = element_[static_cast<std::size_t>(i)];
      const auto xi = reference_coordinates<E>(element_nodes<E>(*mesh_, e), p);
      if (xi && beyond_faces<E>(*xi) <= 1e-9) return ElementPoint{e, *xi};
    }
    return std::nullopt;
  }

 private:
  using Cell = Eigen::Matrix<Index, 3, 1>;

  Cell cell_of(const Vector3& p) const noexcept {
    const Vector3 scaled = (per_metre_ * (p - low_)).cwiseMax(-1.0).cwiseMin(1e15);
    Cell cell;
    for (int i = 0; i < 3; ++i) cell[i] = static_cast<Index>(std::floor(scaled[i]));
    return cell;
  }
  std::size_t number(const Cell& c) const noexcept {
    return static_cast<std::size_t>(c[0] + cells_[0] * (c[1] + cells_[1] * c[2]));
  }
  /// Calls visit(cell, element) for all cells that the box of an element touches, a little enlarged: curved sides and
  /// points on a border.
  template <class Visit>
  void each_cell(Visit&& visit) const {
    for (Index e = 0; e < mesh_->element_count(); ++e) {
      const ElementNodes<E> x = element_nodes<E>(*mesh_, e);
      const Vector3 low = x.colwise().minCoeff().transpose(), high = x.colwise().maxCoeff().transpose();
      const Vector3 margin = (E::order > 1 ? 0.1 : 1e-6) * Vector3::Constant((high - low).maxCoeff());
      const Cell first = cell_of(low - margin).cwiseMax(Index{0}),
                 last = cell_of(high + margin).cwiseMin(Cell(cells_ - Cell::Ones()));
      for (Index k = first[2]; k <= last[2]; ++k)
        for (Index j = first[1]; j <= last[1]; ++j)
          for (Index i = first[0]; i <= last[0]; ++i) visit(number({i, j, k}), e);
    }
  }

  const Mesh<E>* mesh_;
  Vector3 low_ = Vector3::Zero();
  double per_metre_ = 1.0;
  Cell cells_ = Cell::Ones();
  std::vector<Index> start_, element_;
};

}}  // namespace palpate
