// A contact compliance corrected by observed pairs of forces and displacements.
#include <palpate/model/moving/detail/secant_compliance.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Eigenvalues>

#include "catch.hpp"

using namespace palpate;

namespace {

/// A body whose response is a matrix: not what `respond` of a settled motion would tell.
struct MatrixMotion {
  MatrixX compliance;
  VectorX u;
  bool prepare_response(double) { return true; }
  bool respond(const VectorX& force, VectorX& moved) const {
    moved = compliance * force;
    return true;
  }
  const VectorX& displacement() const { return u; }
};

MatrixX random_compliance(Index size, unsigned seed) {
  testing::Random random(seed);
  MatrixX a(size, size);
  for (Index i = 0; i < a.size(); ++i) a.data()[i] = random.uniform(-1.0, 1.0);
  return MatrixX::Identity(size, size) + 0.2 / static_cast<double>(size) * a * a.transpose();
}

struct CorrectedCase {
  static constexpr int vertices = 6;
  std::vector<NodeId> nodes{0, 1, 2, 3, 4, 5};
  std::vector<Matrix3> rotation{static_cast<std::size_t>(vertices), Matrix3::Identity()};
  detail::VertexCompliance base;
  detail::SecantCompliance secants{vertices, 64};
  detail::SecantTerms terms;

  CorrectedCase() {
    std::vector<Vector3> positions;
    detail::BlockPattern pattern;
    pattern.row_start.push_back(0);
    for (NodeId i = 0; i < vertices; ++i) {
      positions.push_back(Vector3(i % 2, i / 2, (i * i) % 5));
      for (NodeId j = 0; j <= i; ++j) pattern.column.push_back(j);
      pattern.row_start.push_back(static_cast<Index>(pattern.column.size()));
    }
    MatrixMotion motion{random_compliance(3 * vertices, 3), VectorX::Zero(3 * vertices)};
    base = detail::VertexCompliance(
        detail::WarpedCompliance(motion, 1.0, nodes, detail::NodalRotations(pattern, positions, nodes), {}));
    for (auto& term : terms.term) term.resize(vertices);
  }
  Matrix3 at(int i, int j) const {
    return base.rotated(rotation, i, j) + terms(static_cast<std::size_t>(i), static_cast<std::size_t>(j));
  }
  MatrixX all() const {
    MatrixX c(3 * vertices, 3 * vertices);
    for (int i = 0; i < vertices; ++i)
      for (int j = 0; j < vertices; ++j) c.block<3, 3>(3 * i, 3 * j) = at(i, j);
    return c;
  }
};

std::vector<VertexForce> as_forces(const VectorX& f) {
  std::vector<VertexForce> forces;
  for (int i = 0; 3 * i < f.size(); ++i)
    if (const Vector3 own = f.segment<3>(3 * i); own.norm() > 0.0) forces.push_back({i, ModelVector(own)});
  return forces;
}
std::vector<Vector3> as_vectors(const VectorX& u) {
  std::vector<Vector3> vectors;
  for (Index i = 0; i < u.size() / 3; ++i) vectors.push_back(u.segment<3>(3 * i));
  return vectors;
}

}  // namespace

TEST_CASE("the corrected compliance maps the last change of forces to its displacement", "[model][secant]") {
  CorrectedCase c;
  const MatrixX truth = 2.5 * random_compliance(3 * CorrectedCase::vertices, 8);
  testing::Random random(1);
  VectorX f = VectorX::Zero(truth.rows());
  for (int step = 0; step < 8; ++step) {
    VectorX g = VectorX::Zero(f.size());  // other vertices in every step
    for (int i = 0; i < 9; ++i) g[(3 * step + i) % g.size()] = random.uniform(-1.0, 1.0);
    const VectorX u = truth * f, v = truth * g;
    c.secants.record(as_forces(f), as_forces(g), as_vectors(u), as_vectors(v), 0.0);
    c.secants.find_terms(c.base, c.rotation, c.terms);
    CHECK(c.terms.count == std::min<std::size_t>(detail::SecantTerms::most, static_cast<std::size_t>(step) + 1));
    const MatrixX corrected = c.all();
    CHECK((corrected * (g - f) - (v - u)).norm() <= 1e-10 * (v - u).norm());
    CHECK((corrected - corrected.transpose()).norm() <= 1e-12 * corrected.norm());
    CHECK(Eigen::SelfAdjointEigenSolver<MatrixX>(corrected).eigenvalues().minCoeff() > 0.0);
    for (int j = 0; j < CorrectedCase::vertices; ++j)
      for (std::size_t i = 0; i < CorrectedCase::vertices; ++i)
        CHECK(c.terms(i, static_cast<std::size_t>(j)).norm() <=
              c.terms.bound(static_cast<std::size_t>(j)) * (1.0 + 1e-12));
    f = g;
  }
}

TEST_CASE("pairs that say nothing are not used", "[model][secant]") {
  CorrectedCase c;
  const Index size = 3 * CorrectedCase::vertices;
  VectorX f = VectorX::Zero(size), g = f, u = f, v = f;
  f[4] = 1.0;
  v[4] = 1.0;
  const auto count_of = [&](double change, double error, double moved) {
    c.secants.clear();
    g = f;
    g[4] += change;
    v[4] = moved;
    c.secants.record(as_forces(f), as_forces(g), as_vectors(u), as_vectors(v), error);
    c.secants.find_terms(c.base, c.rotation, c.terms);
    return c.terms.count;
  };
  CHECK(count_of(0.1, 0.0, 0.2) == 1);
  CHECK(count_of(1e-4, 0.0, 2e-4) == 0);  // hardly a change
  CHECK(count_of(0.1, 0.05, 0.2) == 0);   // less than the error
  CHECK(count_of(0.1, 0.0, -0.2) == 0);   // against the force
  CHECK(count_of(0.1, 0.0, 100.0) == 0);  // a thousand times softer
}
