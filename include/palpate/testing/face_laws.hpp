// The laws of an element's faces.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/quadrature_laws.hpp>
#include <palpate/testing/reference_cell.hpp>
#include <palpate/testing/shape_laws.hpp>
#include <palpate/testing/violation.hpp>

#include <cmath>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

template <class F>
using FaceNodes = Eigen::Matrix<double, F::nodes, 3>;

/// Vector element of area dx/du x dx/dv of a face whose nodes are the rows of x.
template <FaceElement F>
Vector3 area_element(const FaceNodes<F>& x, const Vector2& xi) {
  const Eigen::Matrix<double, 3, 2> t = x.transpose() * F::gradient(xi);
  return cross(t.col(0), t.col(1));
}

/// Area vector of a face: its area times its mean normal.
template <FaceElement F>
Vector3 area_vector(const FaceNodes<F>& x) {
  Vector3 sum = Vector3::Zero();
  for (const auto& q : F::Quadrature::points) sum += q.weight * area_element<F>(x, point_of(q.xi));
  return sum;
}

/// Integral of x . n over a face: three times the volume of the cone to the origin.
template <FaceElement F>
double flux_of_position(const FaceNodes<F>& x) {
  double sum = 0.0;
  for (const auto& q : F::Quadrature::points) {
    const Vector3 here = x.transpose() * F::shape(point_of(q.xi));
    sum += q.weight * here.dot(area_element<F>(x, point_of(q.xi)));
  }
  return sum;
}

/// Reference coordinates of the nodes of face number f.
template <FaceElement F, Element E>
FaceNodes<F> reference_face(std::size_t f) {
  const ElementNodes<E> x = E::reference_nodes();
  const auto local = palpate::detail::local_face<E>(f);
  FaceNodes<F> face;
  for (std::size_t a = 0; a < local.size(); ++a) face.row(static_cast<Eigen::Index>(a)) = x.row(local[a]);
  return face;
}

/// Largest difference between the element's shape functions on face f and those of the face element (zero for nodes off
/// the face).
template <FaceElement F, Element E>
double trace_error(std::size_t f) {
  const auto x = reference_face<F, E>(f);
  const auto local = palpate::detail::local_face<E>(f);
  double worst = 0.0;
  for (const auto& xi : sample_points<F::nodes, 2>(F::reference_nodes())) {
    const Eigen::Matrix<double, F::nodes, 1> on_face = F::shape(xi);
    Eigen::Matrix<double, E::nodes, 1> difference = E::shape(Vector3(x.transpose() * on_face));
    for (std::size_t a = 0; a < local.size(); ++a) difference[local[a]] -= on_face[static_cast<Eigen::Index>(a)];
    const double error = difference.norm();  // unlike maxCoeff, it keeps a NaN
    if (!(error <= worst)) worst = error;
    if (std::isnan(worst)) break;
  }
  return worst;
}

/// The laws of face f. Also returns its contributions to the sums over all faces: its area vector and the flux of the
/// position through it.
template <FaceElement F, Element E>
Violations one_face_laws(std::size_t f, Vector3& area, double& flux) {
  constexpr double bound = 1e-12;
  Violations v;
  const ElementNodes<E> nodes = E::reference_nodes();
  const Vector3 centroid = nodes.colwise().mean().transpose();
  const double size = (nodes.rowwise() - centroid.transpose()).rowwise().norm().maxCoeff();
  const std::string name = "face " + std::to_string(f);
  const auto x = reference_face<F, E>(f);
  const Vector3 middle = x.colwise().mean().transpose();
  area = area_vector<F>(x);
  flux = flux_of_position<F>(x);
  const Vector3 normal = area / area.norm();
  const Eigen::Matrix<double, E::nodes, 1> height = (nodes.rowwise() - middle.transpose()) * normal;
  const Eigen::Matrix<double, F::nodes, 1> off_plane = (x.rowwise() - middle.transpose()) * normal;
  expect_at_most(v, "face is plane", off_plane.norm(), bound * size, name);
  expect_above(v, "face is outward", normal.dot(middle - centroid), 0.0, name);
  expect_at_most(v, "face bounds the element", height.maxCoeff(), bound * size, name);
  expect_at_most(v, "face shape functions are the trace of the element's", trace_error<F, E>(f), bound, name);
  return v;
}

/// "face is plane", "face is outward" (right-hand rule, against the centroid), "face bounds the element" (no node lies
/// beyond it), "face shape functions are the trace of the element's", "faces are closed" (area vectors sum to zero),
/// "faces enclose the reference volume". Face nodes must be in range.
template <Element E>
Violations face_laws() {
  constexpr double bound = 1e-12;
  Violations v;
  const ElementNodes<E> nodes = E::reference_nodes();
  const double size = (nodes.rowwise() - nodes.colwise().mean()).rowwise().norm().maxCoeff();
  Vector3 closed = Vector3::Zero();
  double volume = 0.0;
  for (std::size_t f = 0; f < E::faces.size(); ++f) {
    Vector3 area = Vector3::Zero();
    double flux = 0.0;
    append(v, palpate::detail::with_face_element<E>(palpate::detail::local_face<E>(f).size(), [&]<FaceElement F>() {
             return one_face_laws<F, E>(f, area, flux);
           }));
    closed += area;
    volume += flux / 3.0;
  }
  expect_at_most(v, "faces are closed", closed.norm(), bound * size * size);
  expect_at_most(v, "faces enclose the reference volume", std::abs(volume - E::reference_volume),
                 bound * size * size * size);
  return v;
}

}}}  // namespace palpate::testing
