// Concepts of finite elements: shape functions on a reference domain, as a stateless type.
#pragma once

#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// A surface element: `nodes` shape functions of two reference coordinates.
/// `shape(xi)` is nodes x 1, `gradient(xi)` nodes x 2, `reference_nodes()` nodes x 2.
template <class F>
concept FaceElement = requires(const Eigen::Vector2d& xi) {
  requires F::nodes > 0;
  { F::shape(xi) } noexcept -> FixedVector<F::nodes>;
  { F::gradient(xi) } noexcept -> FixedMatrix<F::nodes, 2>;
  { F::reference_nodes() } noexcept -> FixedMatrix<F::nodes, 2>;
  requires Quadrature<typename F::Quadrature>;
  requires F::Quadrature::dimension == 2;
};

/// A face that tools can touch: `triangles` lists the local nodes of linear triangles that cover the face, with the
/// same orientation as the face and with every node as a vertex. Contact detection uses these triangles, and
/// interpolates displacement and distributes force with their barycentric weights (docs/contact.md). Laws:
/// testing/element_laws.hpp.
template <class F>
concept TriangulatedFace = FaceElement<F> &&
    std::same_as<std::remove_cvref_t<decltype(F::triangles)>, std::array<std::array<int, 3>, F::triangles.size()>>;

/// A solid element: `nodes` shape functions of three reference coordinates (thesis 3.3.2).
/// `shape(xi)` is nodes x 1, `gradient(xi)` nodes x 3 (derivatives by xi), `reference_nodes()` nodes x 3.
/// `faces` lists the local nodes of every face, outward by the right-hand rule. All faces are of type `Face`, or some
/// are of a type `SmallFace` with fewer nodes; those lists end in -1.
/// `order` is the polynomial degree reproduced exactly. `Quadrature` is the default rule for stiffness;
/// `MassQuadrature` integrates products of two shape functions exactly on straight-sided elements. Laws:
/// testing/element_laws.hpp.
template <class E>
concept Element = requires(const Vector3& xi) {
  typename std::integral_constant<int, E::nodes>;
  requires E::nodes > 0;
  requires E::order > 0;
  { E::shape(xi) } noexcept -> FixedVector<E::nodes>;
  { E::gradient(xi) } noexcept -> FixedMatrix<E::nodes, 3>;
  { E::reference_nodes() } noexcept -> FixedMatrix<E::nodes, 3>;
  requires FaceElement<typename E::Face>;
  requires std::same_as<std::remove_cvref_t<decltype(E::faces)>,
                        std::array<std::array<int, E::Face::nodes>, E::faces.size()>>;
  requires Quadrature<typename E::Quadrature>;
  requires E::Quadrature::dimension == 3;
  requires Quadrature<typename E::MassQuadrature>;
  requires E::MassQuadrature::dimension == 3;
  { E::reference_volume } -> std::convertible_to<double>;
};

/// An element with two kinds of faces, such as a wedge or a hexahedron with more nodes along one axis.
template <class E>
concept HasSmallFace = Element<E> && FaceElement<typename E::SmallFace> && (E::SmallFace::nodes < E::Face::nodes);

namespace detail {

/// Whether all faces of E can be touched.
template <Element E>
constexpr bool has_triangulated_faces() noexcept {
  if constexpr (HasSmallFace<E>)
    if (!TriangulatedFace<typename E::SmallFace>) return false;
  return TriangulatedFace<typename E::Face>;
}

/// Local nodes of face f.
template <Element E>
constexpr std::span<const int> local_face(std::size_t f) noexcept {
  std::size_t count = E::faces[f].size();
  if constexpr (HasSmallFace<E>)
    if (E::faces[f].back() < 0) count = static_cast<std::size_t>(E::SmallFace::nodes);
  return {E::faces[f].data(), count};
}

/// Whether a face of E can have `nodes` nodes.
template <Element E>
constexpr bool is_face_size(std::size_t nodes) noexcept {
  if constexpr (HasSmallFace<E>)
    if (nodes == static_cast<std::size_t>(E::SmallFace::nodes)) return true;
  return nodes == static_cast<std::size_t>(E::Face::nodes);
}

/// Calls visit.template operator()<F>(), where F is the type of a face with `nodes` nodes.
template <Element E, class Visit>
constexpr decltype(auto) with_face_element([[maybe_unused]] std::size_t nodes, Visit&& visit) {
  if constexpr (HasSmallFace<E>)
    if (nodes == static_cast<std::size_t>(E::SmallFace::nodes))
      return visit.template operator()<typename E::SmallFace>();
  return visit.template operator()<typename E::Face>();
}

}  // namespace detail

/// Coordinates of the nodes of one element, one node per row.
template <class E>
using ElementNodes = Eigen::Matrix<double, E::nodes, 3>;

}}  // namespace palpate
