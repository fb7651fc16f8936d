// Energy, force and tangent stiffness of a body at any deformation: total Lagrangian.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/material/detail/material_range.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>

#include <Eigen/LU>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// No history: the material of a point is that of its region, and steps cost nothing.
struct NoHistory {
  template <class Body>
  void start(const Body&, const SetupLimits&) noexcept {}
  template <class Body>
  static decltype(auto) material(const Body& body, Index e, std::size_t) noexcept {
    return body.material_of(e);
  }
};

/// The history of a Prony series: (2 + terms) x 72 bytes per point. Only `start` allocates.
template <ViscousMaterial M, std::size_t Points>
class PronyPoints {
 public:
  /// Initialises the history at rest and begins a step of length 0.
  template <class Body>
  void start(const Body& body, const SetupLimits& limits) {
    const auto count = static_cast<std::size_t>(body.rest.mesh.element_count());
    limits.require_memory(static_cast<double>(count) * Points * sizeof(Point),
                          "the viscoelastic history of the integration points");
    points_.resize(count);
    steps_.resize(body.materials.size());
    begin_step(body, 0.0);
  }

  template <class Body>
  auto material(const Body& body, Index e, std::size_t q) const noexcept {
    const Point& point = points_[static_cast<std::size_t>(e)][q];
    return body.material_of(e).material_of_step(steps_[body.rest.region_of(e)], point.driving);
  }

  template <class Body>
  void begin_step(const Body& body, double dt) noexcept {
    for (std::size_t r = 0; r < steps_.size(); ++r) steps_[r] = body.materials[r].over(dt);
    for (std::size_t e = 0; e < points_.size(); ++e)
      for (Point& point : points_[e])
        point.driving = M::driving_stress(point.history, steps_[body.rest.region_of(static_cast<Index>(e))]);
  }
  template <class Body>
  void update_history(const Body& body, Index e, std::size_t q, const Tensor3<double>& f) noexcept {
    if (body.material_of(e).admits(f))
      body.material_of(e).update_history(f, points_[static_cast<std::size_t>(e)][q].history,
                                         steps_[body.rest.region_of(e)]);
  }

 private:
  struct Point {
    typename M::LargeStrainHistory history;
    Tensor3<double> driving{};
  };

  std::vector<std::array<Point, Points>> points_;
  std::vector<decltype(std::declval<const M&>().over(0.0))> steps_;  // by region
};

template <class M, std::size_t Points>
struct PointHistory {
  using type = NoHistory;
};
template <ViscousMaterial M, std::size_t Points>
struct PointHistory<M, Points> {
  using type = PronyPoints<M, Points>;
};

}  // namespace detail

/// Integrates a body over its shape at rest (Belytschko, Liu, Moran, Nonlinear Finite Elements, 4.9): F = I + sum u_a
/// grad N_a, f_a = sum_q P grad N_a dV. Gradients and volumes are computed once: (3 nodes + 1) x 8 bytes per
/// integration point, plus the viscoelastic history. Vectors have 3 entries per node, all dofs. Only the constructor
/// allocates; sums run by element, so results do not depend on threads.
template <Element E, LargeStrainMaterial M>
class LargeStrain final : public ElasticForces {
 public:
  static_assert(!detail::HasSmoothedStrain<E> && !detail::HasMeanDilatation<E>,
                "palpate: Smoothed and MeanDilatation average small strains; choose Tet10 or Hex20, or "
                "Implicit<QuasiNewton<>> for Smoothed<Tet4>");
  static constexpr bool has_history = ViscousMaterial<M>;

  /// Throws inverted_element or non_finite for a mesh that is invalid at rest, too_large.
  explicit LargeStrain(HyperelasticBody<E, M> body, const SetupLimits& limits = {}) : body_(std::move(body)) {
    const Mesh<E>& mesh = body_.rest.mesh;
    limits.require_memory(static_cast<double>(mesh.element_count()) * sizeof(Points), "the gradients at rest");
    probe_length_ = std::sqrt(std::numeric_limits<double>::epsilon()) * detail::shortest_edge(mesh);
    points_.resize(static_cast<std::size_t>(mesh.element_count()));
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const ElementNodes<E> x = element_nodes<E>(mesh, e);
      if (!detail::is_positively_oriented<E>(x))
        detail::raise_element(SetupErrorKind::inverted_element, e, "has a negative Jacobian at an integration point");
      for (std::size_t q = 0; q < point_count; ++q) {
        const auto& point = E::Quadrature::points[q];
        detail::PointGeometry<E>& g = points_[static_cast<std::size_t>(e)][q];
        g = detail::point_geometry<E>(x, detail::reference_point(point), point.weight);
        if (!g.gradient.allFinite())
          detail::raise_element(SetupErrorKind::non_finite, e, "has gradients that are not finite");
      }
    }
    history_.start(body_, limits);
  }

  const HyperelasticBody<E, M>& body() const noexcept { return body_; }
  const Mesh<E>& mesh() const noexcept { return body_.rest.mesh; }
  Index size() const noexcept override { return 3 * mesh().node_count(); }

  /// Stored energy [J]; infinite where a material is not admissible.
  double energy(const VectorX& u) const noexcept override {
    double sum = 0.0;
    for (Index e = 0; e < mesh().element_count(); ++e) {
      const Displacements ue = displacements(e, u);
      for (const detail::PointGeometry<E>& g : points_of(e)) {
        const Tensor3<double> f = deformation_gradient(ue, g);
        const auto& material = material_at(e, g);
        if (!material.admits(f)) return infinity;
        sum += g.volume * material.energy(f);
      }
    }
    return sum;
  }

  /// Internal forces at a displacement [N], derivative of the energy. Points where the material is not admissible add
  /// nothing.
  DeformationReport force(const VectorX& u, VectorX& all) const noexcept override {
    DeformationReport report;
    all.setZero();
    for (Index e = 0; e < mesh().element_count(); ++e) {
      const Displacements ue = displacements(e, u);
      Displacements fe = Displacements::Zero();
      bool inverted = false, beyond = false;
      detail::MostStrained<detail::PointGeometry<E>> most;
      for (const detail::PointGeometry<E>& g : points_of(e)) {
        const Tensor3<double> f = deformation_gradient(ue, g);
        inverted = !observe(determinant(f), e, report) || inverted;
        const auto& material = material_at(e, g);
        if constexpr (requires { material.is_beyond_range(f); })
          beyond = beyond || material.is_beyond_range(f);
        else
          most.note(f, g);
        if (material.admits(f))
          fe.noalias() += g.volume * matrix3(material.stress(f)) * g.gradient.transpose();
        else
          report.admissible = false;
      }
      report.inverted += inverted ? 1 : 0;
      if (most.at != nullptr) beyond = beyond || detail::is_beyond_range(material_at(e, *most.at), most.deformation);
      report.beyond_range += beyond ? 1 : 0;
      for (int a = 0; a < E::nodes; ++a) all.template segment<3>(3 * Index{mesh().element_node(e, a)}) += fe.col(a);
    }
    return report;
  }

  /// Derivative of the internal force, into a matrix on block_pattern(mesh). Not always positive definite.
  void tangent(const VectorX& u, BlockMatrix& k) const noexcept override {
    k.set_zero();
    for (Index e = 0; e < mesh().element_count(); ++e) {
      const Displacements ue = displacements(e, u);
      for (const detail::PointGeometry<E>& g : points_of(e)) {
        const Tensor3<double> f = deformation_gradient(ue, g);
        if (const auto& material = material_at(e, g); material.admits(f)) add_tangent(e, g, material.tangent(f), k);
      }
    }
  }

  /// A small fraction of the shortest edge [m], chosen so that differences of forces keep half their digits.
  double probe_length() const noexcept { return probe_length_; }

  void begin_step(double dt) noexcept override {
    if constexpr (has_history) history_.begin_step(body_, dt);
  }
  void end_step(const VectorX& u) noexcept override {
    if constexpr (has_history)
      for (Index e = 0; e < mesh().element_count(); ++e) {
        const Displacements ue = displacements(e, u);
        for (const detail::PointGeometry<E>& g : points_of(e))
          history_.update_history(body_, e, number_of(e, g), deformation_gradient(ue, g));
      }
  }

 private:
  static constexpr std::size_t point_count = E::Quadrature::points.size();
  using Points = std::array<detail::PointGeometry<E>, point_count>;
  using Displacements = Eigen::Matrix<double, 3, E::nodes>;  // one per column
  using TangentBlock = Eigen::Matrix<double, 9, 3>;

  std::size_t number_of(Index e, const detail::PointGeometry<E>& g) const noexcept {
    return static_cast<std::size_t>(&g - points_of(e).data());
  }
  /// The material of a point; with viscoelastic history, that of the current step.
  decltype(auto) material_at(Index e, const detail::PointGeometry<E>& g) const noexcept {
    return history_.material(body_, e, number_of(e, g));
  }
  const Points& points_of(Index e) const noexcept { return points_[static_cast<std::size_t>(e)]; }

  Displacements displacements(Index e, const VectorX& u) const noexcept {
    Displacements ue;
    for (int a = 0; a < E::nodes; ++a) ue.col(a) = u.template segment<3>(3 * Index{mesh().element_node(e, a)});
    return ue;
  }
  static Tensor3<double> deformation_gradient(const Displacements& u, const detail::PointGeometry<E>& g) noexcept {
    Matrix3 f = Matrix3::Identity();
    f.noalias() += u * g.gradient;
    return tensor3<double>(f);
  }
  static bool observe(double volume_ratio, Index e, DeformationReport& report) noexcept {
    if (!(volume_ratio >= report.smallest_volume_ratio)) {
      report.smallest_volume_ratio = volume_ratio;
      report.worst_element = e;
    }
    return volume_ratio > 0.0;
  }

  /// K_ab += dV grad N_a . A . grad N_b; rows and columns of A are i + 3 j for F_ij.
  void add_tangent(Index e, const detail::PointGeometry<E>& g, const Matrix9& a9, BlockMatrix& k) const noexcept {
    for (int b = 0; b < E::nodes; ++b) {
      TangentBlock right = TangentBlock::Zero();
      for (int l = 0; l < 3; ++l) right += g.volume * g.gradient(b, l) * a9.template middleCols<3>(3 * l);
      const NodeId column = mesh().element_node(e, b);
      for (int a = 0; a < E::nodes; ++a) {
        const NodeId row = mesh().element_node(e, a);
        if (column > row) continue;
        Matrix3 block = Matrix3::Zero();
        for (int j = 0; j < 3; ++j) block += g.gradient(a, j) * right.template middleRows<3>(3 * j);
        k.block(k.pattern().find(row, column)) += block;
      }
    }
  }

  HyperelasticBody<E, M> body_;
  std::vector<Points> points_;
  [[no_unique_address]] typename detail::PointHistory<M, point_count>::type history_;
  double probe_length_ = 0.0;
};

}}  // namespace palpate
