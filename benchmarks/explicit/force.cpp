// Time of the internal force per element.
#include <Eigen/Geometry>

#include "explicit.hpp"

namespace explicit_path {
namespace {

/// A straightforward implementation without batches: element by element, scalar, with Eigen; gradients at rest are
/// stored.
class PlainLoop {
 public:
  explicit PlainLoop(const Mesh<Tet4>& mesh) : mesh_(mesh) {
    for (Index e = 0; e < mesh.element_count(); ++e) geometry_.push_back(detail::constant_geometry<Tet4>(mesh, e));
  }
  void force(const VectorX& u, VectorX& f) const {
    const double lambda = soft.small_strain().lame_lambda(), mu = soft.small_strain().shear_modulus();
    f.setZero();
    for (std::size_t e = 0; e < geometry_.size(); ++e) {
      const auto& nodes = mesh_.elements[e];
      const auto& g = geometry_[e];
      Eigen::Matrix<double, 3, 4> ue;
      for (int a = 0; a < 4; ++a) ue.col(a) = u.segment<3>(3 * Index{nodes[static_cast<std::size_t>(a)]});
      Matrix3 def = Matrix3::Identity();
      def.noalias() += ue * g.gradient;
      Matrix3 cofactor;
      cofactor.col(0) = def.col(1).cross(def.col(2));
      cofactor.col(1) = def.col(2).cross(def.col(0));
      cofactor.col(2) = def.col(0).cross(def.col(1));
      const double j = def.col(0).dot(cofactor.col(0));
      const Matrix3 stress = g.volume * (mu * def + ((lambda + mu) * j - (lambda + 2.0 * mu)) * cofactor);
      ue.noalias() = stress * g.gradient.transpose();
      for (int a = 0; a < 4; ++a) f.segment<3>(3 * Index{nodes[static_cast<std::size_t>(a)]}) += ue.col(a);
    }
  }

 private:
  const Mesh<Tet4>& mesh_;
  std::vector<detail::PointGeometry<Tet4>> geometry_;
};

std::string nanoseconds(double seconds) {
  return bench::with_unit(1e9 * seconds, "ns/tet");
}

template <class S>
void measure(bench::RowFile& rows, const HyperelasticBody<Tet4, NeoHookean>& body, const PlainLoop& plain,
             const VectorX& u, const char* scalar, double most) {
  BatchedTetrahedra<NeoHookean, S> batched(body);
  VectorX exact(u.size()), f(u.size());
  const auto elements = static_cast<double>(body.rest.mesh.element_count());
  const auto [ours, theirs] = bench::medians_in_turns([&] { batched.force(u, f); }, [&] { plain.force(u, exact); },
                                                      {.seconds = 2.0, .least = 101, .most = 2001});
  const double error = (f - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
  char text[64];
  std::snprintf(text, sizeof text, ", largest error %.1e", error);
  const std::string what =
      std::string("neo-Hookean force, ") + scalar + ", " + std::to_string(body.rest.mesh.element_count()) + " tets";
  const std::string wrong = error <= (sizeof(S) == 8 ? 1e-13 : 2e-6) ? "" : "differs from the force of the plain loop";
  rows.add({.target = "m",
            .what = what,
            .figure = nanoseconds(ours / elements) + text,
            .baseline = "most: " + std::to_string(static_cast<int>(most)) + " ns/tet",
            .ratio = 1e9 * ours / elements,
            .bound = bench::at_most(most),
            .error = wrong});
  rows.add({.target = "m",
            .what = what + ", against plain Eigen",
            .figure = nanoseconds(ours / elements),
            .baseline = nanoseconds(theirs / elements),
            .ratio = theirs / ours,
            .bound = {},
            .error = wrong});
}

}  // namespace

void measure_force(bench::RowFile& rows, int n) {
  const auto body = soft_block(n);
  const PlainLoop plain(body.rest.mesh);
  testing::Random random(3);
  VectorX u(3 * body.rest.mesh.node_count());
  for (double& x : u) x = 0.01 / n * random.uniform(-1.0, 1.0);
  measure<double>(rows, body, plain, u, "double", 10.0);
  measure<float>(rows, body, plain, u, "float", 8.0);
}

}  // namespace explicit_path
