// The reference domain of an element, deduced from its nodes and faces.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/reference_cell.hpp>

#include <algorithm>
#include <cmath>
#include <optional>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// True when every face lists nodes the element has.
template <Element E>
bool face_nodes_in_range() {
  for (std::size_t f = 0; f < E::faces.size(); ++f)
    for (int a : local_face<E>(f))
      if (a < 0 || a >= E::nodes) return false;
  return true;
}

/// Local numbers of the corners in ascending order: nodes on three faces or more (mid-edge nodes are on two).
template <Element E>
std::vector<int> corners_of() {
  std::vector<int> corners;
  for (int a = 0; a < E::nodes; ++a) {
    std::size_t count = 0;
    for (const auto& face : E::faces) count += std::ranges::count(face, a) > 0 ? 1 : 0;
    if (count >= 3) corners.push_back(a);
  }
  return corners;
}

/// The cell with these corners: Dim + 1 corners form a simplex, 2^Dim an axis-aligned box; std::nullopt for anything
/// else.
template <int Dim>
std::optional<ReferenceCell<Dim>> cell_with_corners(const std::vector<Point<Dim>>& corners) {
  if (corners.size() == static_cast<std::size_t>(Dim + 1)) {
    ReferenceCell<Dim> cell{Dim == 2 ? Domain::triangle : Domain::tetrahedron, corners[0]};
    for (int i = 0; i < Dim; ++i) cell.axes.col(i) = corners[static_cast<std::size_t>(i + 1)] - corners[0];
    return cell;
  }
  if (corners.size() != std::size_t{1} << Dim) return std::nullopt;
  Point<Dim> low = corners[0], high = corners[0];
  for (const auto& c : corners) {
    low = low.cwiseMin(c);
    high = high.cwiseMax(c);
  }
  ReferenceCell<Dim> cell{Dim == 2 ? Domain::quadrilateral : Domain::hexahedron, 0.5 * (low + high)};
  cell.axes = Point<Dim>(0.5 * (high - low)).asDiagonal();
  for (const auto& c : corners)
    if (!((cell.to_standard(c).cwiseAbs().array() - 1.0).abs().maxCoeff() < 1e-12)) return std::nullopt;
  return cell;
}

/// Reference cell of a solid element: a tetrahedron or a box.
template <Element E>
std::optional<ReferenceCell<3>> cell_of() {
  std::vector<Point<3>> corners;
  const ElementNodes<E> x = E::reference_nodes();
  for (int a : corners_of<E>()) corners.push_back(x.row(a).transpose());
  return cell_with_corners<3>(corners);
}

/// Reference cell of a surface element. A corner is a node from which all others are within an angle of less than pi.
template <FaceElement F>
std::optional<ReferenceCell<2>> cell_of() {
  const Eigen::Matrix<double, F::nodes, 2> x = F::reference_nodes();
  const Vector2 centre = x.colwise().mean().transpose();
  std::vector<Point<2>> corners;
  for (int a = 0; a < F::nodes; ++a) {
    const Vector2 p = x.row(a).transpose();
    const Vector2 inward = centre - p;
    double left = 0.0, right = 0.0;
    for (int b = 0; b < F::nodes; ++b) {
      if (b == a) continue;
      const Vector2 to = x.row(b).transpose() - p;
      const double angle = std::atan2(inward[0] * to[1] - inward[1] * to[0], inward.dot(to));
      left = std::max(left, angle);
      right = std::min(right, angle);
    }
    if (inward.norm() > 0.0 && left - right < 3.14159) corners.push_back(p);
  }
  return cell_with_corners<2>(corners);
}

}}}  // namespace palpate::testing
