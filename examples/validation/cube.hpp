// Finite element models of the cube: displacements at the beads.
#pragma once

#include "../../benchmarks/accuracy/meshes.hpp"
#include "../../benchmarks/accuracy/statics.hpp"
#include "beads.hpp"

#include <palpate/material/neo_hookean.hpp>
#include <palpate/model/moving/equilibrium.hpp>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace truth_cube {

using accuracy::body_of, accuracy::box_of, accuracy::solve_static;

/// One displacement per bead [m].
using Motion = std::vector<Vector3>;

inline constexpr LinearElastic rubber{.youngs_modulus = 15.3e3, .poisson_ratio = 0.499, .density = 980.0};

/// The same material at large strain.
inline constexpr NeoHookean large_strain_rubber{
    .youngs_modulus = rubber.youngs_modulus, .poisson_ratio = rubber.poisson_ratio, .density = rubber.density};

/// Solves for the displacement of the nodes with linear elasticity.
struct Linear {
  template <Element E>
  VectorX operator()(const Mesh<E>& mesh, const Scene& scene) const {
    return solve_static(body_of(mesh, {rubber}), scene).displacement;
  }
};
/// The same at large strain; throws not_converged.
struct AtLargeStrain {
  template <Element E>
  VectorX operator()(const Mesh<E>& mesh, const Scene& scene) const {
    Equilibrium body(mesh, scene, large_strain_rubber);
    const EquilibriumReport report = body.solve();
    if (!report.converged || !report.stable || report.deformation.inverted > 0)
      raise(SetupErrorKind::not_converged, describe(report));
    return body.displacement();
  }
};

/// Trilinear interpolation of a value given at the beads, at `place` in 0 ... 6 along every axis.
template <class Value>
Vector3 between_beads(const Vector3& place, Value value) {
  std::array<int, 3> cell{};
  Vector3 t;
  for (int a = 0; a < 3; ++a) {
    cell[static_cast<std::size_t>(a)] = std::clamp(int(std::floor(place[a] + 1e-9)), 0, per_side - 2);
    t[a] = place[a] - cell[static_cast<std::size_t>(a)];
  }
  Vector3 sum = Vector3::Zero();
  for (int c = 0; c < 8; ++c) {
    double weight = 1.0;
    std::size_t index = 0, stride = 1;
    for (int a = 0; a < 3; ++a, stride *= per_side) {
      const int far = c >> a & 1;
      weight *= far == 1 ? t[a] : 1.0 - t[a];
      index += stride * static_cast<std::size_t>(cell[static_cast<std::size_t>(a)] + far);
    }
    sum += weight * value(index);
  }
  return sum;
}

/// (a) The body between the beads, `cells` per gap, with the measured motion prescribed on its whole surface: no
/// assumptions on platen and base are needed. The motion of the 125 beads inside is predicted.
template <Element E, class Solve>
Motion inside_measured_shell(const std::vector<Bead>& beads, std::size_t state, int cells, Solve solve) {
  const int n = (per_side - 1) * cells;
  const double side = per_side - 1;
  Mesh<E> mesh = box_of<E>({side, side, side}, {n, n, n});
  const std::vector<Vector3> places = mesh.positions;
  for (Vector3& x : mesh.positions) x = between_beads(x, [&](std::size_t b) { return beads[b].rest; });
  Scene scene;
  for (const NodeId i : nodes_of(extract_boundary<E>(mesh))) {
    const Vector3 u =
        between_beads(places[static_cast<std::size_t>(i)], [&](std::size_t b) { return beads[b].displacement[state]; });
    scene.prescribe(std::vector<NodeId>{i}, {u[0], u[1], u[2]});
  }
  const VectorX u = solve(mesh, scene);
  Motion motion(beads.size());
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vector3 nearest = places[static_cast<std::size_t>(i)].array().round();
    if ((places[static_cast<std::size_t>(i)] - nearest).norm() > 1e-9) continue;
    motion[static_cast<std::size_t>(nearest[0] + per_side * (nearest[1] + per_side * nearest[2]))] =
        u.segment<3>(3 * i);
  }
  return motion;
}

/// Displacement of a box of straight-edged elements at the positions of the beads.
template <Element E>
Motion at_beads(const Mesh<E>& mesh, const VectorX& u, const std::vector<Bead>& beads) {
  constexpr bool tetrahedra = E::faces.size() == 4;
  const Vector3 centre = tetrahedra ? Vector3::Constant(0.25) : Vector3::Zero();
  Motion motion(beads.size(), Vector3::Constant(std::numeric_limits<double>::quiet_NaN()));
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(mesh, e);
    const Vector3 low = x.colwise().minCoeff(), high = x.colwise().maxCoeff(),
                  middle = x.transpose() * E::shape(centre);
    const Matrix3 inverse = Matrix3(x.transpose() * E::gradient(centre)).inverse();  // the map is affine
    for (std::size_t b = 0; b < beads.size(); ++b) {
      const Vector3& p = beads[b].rest;
      if ((p - low).minCoeff() < -1e-12 || (high - p).minCoeff() < -1e-12) continue;
      const Vector3 xi = centre + inverse * (p - middle);
      if (tetrahedra ? xi.minCoeff() < -1e-9 || xi.sum() > 1.0 + 1e-9 : xi.cwiseAbs().maxCoeff() > 1.0 + 1e-9) continue;
      const auto shape = E::shape(xi);
      motion[b].setZero();
      for (int a = 0; a < E::nodes; ++a) motion[b] += shape[a] * u.segment<3>(3 * Index{mesh.element_node(e, a)});
    }
  }
  return motion;
}

/// Parameters of the platen motion: travel along z, shift along x and y [m], widening of the side in contact [-].
using PlatenMotion = Eigen::Vector4d;

/// (b) The whole cube of n^3 cells, its base bonded: the motions of the beads for a unit of each part of PlatenMotion.
template <Element E>
std::array<Motion, 4> under_the_platen(const std::vector<Bead>& beads, int n) {
  const Mesh<E> mesh = box_of<E>({edge, edge, edge}, {n, n, n});
  const Body<E> body = body_of(mesh, {rubber});
  Scene widened = Scene().fix("z1");
  for (const NodeId i : mesh.find_group("z0")->nodes)
    widened.prescribe(std::vector<NodeId>{i},
                      {mesh.position(i)[0] - 0.5 * edge, mesh.position(i)[1] - 0.5 * edge, 0.0});
  std::array<Motion, 4> motions;
  const std::array scenes{Scene().fix("z1").prescribe("z0", {0.0, 0.0, 1.0}),
                          Scene().fix("z1").prescribe("z0", {1.0, 0.0, 0.0}),
                          Scene().fix("z1").prescribe("z0", {0.0, 1.0, 0.0}), widened};
  for (std::size_t i = 0; i < 4; ++i) motions[i] = at_beads(mesh, solve_static(body, scenes[i]).displacement, beads);
  return motions;
}

/// (b) at large strain, the platen fixed laterally.
template <Element E>
Motion pushed_far(const std::vector<Bead>& beads, int n, double travel) {
  const Mesh<E> mesh = box_of<E>({edge, edge, edge}, {n, n, n});
  return at_beads(mesh, AtLargeStrain{}(mesh, Scene().fix("z1").prescribe("z0", {0.0, 0.0, travel})), beads);
}

/// The motion of the beads for a motion of the platen.
inline Motion combine(const std::array<Motion, 4>& unit, const PlatenMotion& platen) {
  Motion motion(unit[0].size(), Vector3::Zero());
  for (std::size_t b = 0; b < motion.size(); ++b)
    for (std::size_t i = 0; i < 4; ++i) motion[b] += platen[static_cast<Index>(i)] * unit[i][b];
  return motion;
}

/// The motion of the platen that gives the best fit to the beads of a state, by least squares.
inline PlatenMotion fit(const std::vector<Bead>& beads, const std::array<Motion, 4>& unit, std::size_t state) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  PlatenMotion right = PlatenMotion::Zero();
  for (std::size_t b = 0; b < beads.size(); ++b)
    for (int i = 0; i < 4; ++i) {
      const Vector3& mine = unit[static_cast<std::size_t>(i)][b];
      right[i] += mine.dot(beads[b].displacement[state]);
      for (int j = 0; j < 4; ++j) normal(i, j) += mine.dot(unit[static_cast<std::size_t>(j)][b]);
    }
  return normal.ldlt().solve(right);
}

/// Affine motion with the best fit to the outer beads: a guess without mechanics.
inline Motion affine_from_shell(const std::vector<Bead>& beads, std::size_t state) {
  Eigen::Matrix4d normal = Eigen::Matrix4d::Zero();
  Eigen::Matrix<double, 4, 3> right = Eigen::Matrix<double, 4, 3>::Zero();
  const auto row = [](const Bead& b) { return Eigen::Vector4d(1.0, b.rest[0], b.rest[1], b.rest[2]); };
  for (const Bead& b : beads) {
    if (!b.outer()) continue;
    normal += row(b) * row(b).transpose();
    right += row(b) * b.displacement[state].transpose();
  }
  const Eigen::Matrix<double, 4, 3> factors = normal.ldlt().solve(right);
  Motion motion;
  for (const Bead& b : beads) motion.push_back(factors.transpose() * row(b));
  return motion;
}

}  // namespace truth_cube
