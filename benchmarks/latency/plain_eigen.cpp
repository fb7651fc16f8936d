// A tick without this library, on the same block: a solve, or a product with an inverse.
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/Cholesky>
#include <memory>

#include "palpation.hpp"

namespace {

using namespace latency;
using palpate::MatrixX;
using palpate::VectorX;

/// Stiffness of the free dofs, inverse on the kept ones, and a load on one touchable node.
struct Problem {
  palpate::SparseMatrix k;
  MatrixX inverse;
  Eigen::MatrixXf inverse_float;
  std::vector<palpate::Index> kept;
  palpate::Index loaded;  // index of the kept x dof of the loaded node
  VectorX load, kept_load;

  Problem() {
    Palpation<palpate::Condensed<palpate::SelectiveInverse>> s(blocks[1]);
    const auto& model = s.model();
    palpate::Scene scene;
    scene.fix("z0");
    const auto conditions = palpate::resolve_essential(model.mesh(), model.boundary(), scene);
    k = palpate::free_matrix(palpate::assemble_stiffness<palpate::Tet4>(model.body(), {}), conditions);
    for (palpate::NodeId node : model.touchable_nodes())
      for (int c = 0; c < 3; ++c)
        kept.push_back(conditions.free_index[static_cast<std::size_t>(3 * palpate::Index{node} + c)]);
    const Eigen::SimplicialLDLT<palpate::SparseMatrix> ldlt(k);
    MatrixX unit = MatrixX::Zero(k.rows(), size()), response;
    for (palpate::Index i = 0; i < size(); ++i) unit(kept[static_cast<std::size_t>(i)], i) = 1.0;
    response = ldlt.solve(unit);
    inverse = response(kept, Eigen::all);
    inverse_float = inverse.cast<float>();
    loaded = 3 * (size() / 6);
    load = VectorX::Zero(k.rows());
    kept_load = VectorX::Zero(size());
    kept_load.segment<3>(loaded) << 0.01, 0.02, -0.3;
    for (int c = 0; c < 3; ++c) load[kept[static_cast<std::size_t>(loaded + c)]] = kept_load[loaded + c];
  }
  palpate::Index size() const { return static_cast<palpate::Index>(kept.size()); }

  double error_of_kept(const VectorX& u) const {
    const VectorX truth = inverse * kept_load;
    return (u - truth).norm() / truth.norm();
  }
  double error_of_all(const VectorX& u) const {
    VectorX at_kept(size());
    for (palpate::Index i = 0; i < size(); ++i) at_kept[i] = u[kept[static_cast<std::size_t>(i)]];
    return error_of_kept(at_kept);
  }
};

const Problem& problem() {
  static const Problem p;
  return p;
}

void finish(benchmark::State& state, double error, double allowed, double bytes) {
  state.counters["error"] = error;
  if (!(error < allowed)) state.SkipWithError("the displacement is wrong");
  if (bytes > 0.0)
    state.counters["GB/s"] = benchmark::Counter(1e-9 * bytes, benchmark::Counter::kIsIterationInvariantRate);
}

void sparse_solve(benchmark::State& state) {
  const Eigen::SimplicialLDLT<palpate::SparseMatrix> ldlt(problem().k);
  VectorX u(problem().k.rows());
  for (auto _ : state) benchmark::DoNotOptimize((u = ldlt.solve(problem().load)).data());
  finish(state, problem().error_of_all(u), 1e-8, 0.0);
}
BENCHMARK(sparse_solve)->Name("eigen/SimplicialLDLT_solve")->Unit(benchmark::kMicrosecond);

void sparse_cg(benchmark::State& state) {
  Eigen::ConjugateGradient<palpate::SparseMatrix, Eigen::Lower> cg(problem().k);
  cg.setTolerance(1e-8);
  VectorX u(problem().k.rows());
  for (auto _ : state) benchmark::DoNotOptimize((u = cg.solve(problem().load)).data());
  state.counters["iterations"] = static_cast<double>(cg.iterations());
  finish(state, problem().error_of_all(u), 1e-5, 0.0);
}
BENCHMARK(sparse_cg)->Name("eigen/ConjugateGradient_1e-8")->Unit(benchmark::kMicrosecond);

void full_product(benchmark::State& state) {
  const Problem& p = problem();
  VectorX u(p.size());
  for (auto _ : state) {
    u.noalias() = p.inverse * p.kept_load;
    benchmark::DoNotOptimize(u.data());
  }
  finish(state, p.error_of_kept(u), 1e-10, 8.0 * static_cast<double>(p.size() * p.size()));
}
BENCHMARK(full_product)->Name("eigen/inverse_full_product")->Unit(benchmark::kMicrosecond);

template <class Matrix>
void three_columns(benchmark::State& state, const Matrix& inverse, double allowed) {
  using Scalar = typename Matrix::Scalar;
  const Problem& p = problem();
  const Eigen::Matrix<Scalar, 3, 1> force = p.kept_load.segment<3>(p.loaded).template cast<Scalar>();
  Eigen::Matrix<Scalar, Eigen::Dynamic, 1> u(p.size());
  for (auto _ : state) {
    u.noalias() = inverse.template middleCols<3>(p.loaded) * force;
    benchmark::DoNotOptimize(u.data());
  }
  finish(state, p.error_of_kept(u.template cast<double>()), allowed,
         3.0 * sizeof(Scalar) * static_cast<double>(p.size()));
}
void three_double(benchmark::State& state) {
  three_columns(state, problem().inverse, 1e-10);
}
BENCHMARK(three_double)->Name("eigen/inverse_three_columns")->Unit(benchmark::kMicrosecond);
void three_float(benchmark::State& state) {
  three_columns(state, problem().inverse_float, 1e-5);
}
BENCHMARK(three_float)->Name("eigen/inverse_three_columns_float")->Unit(benchmark::kMicrosecond);

/// The implementation of the library: finds the loaded entries and reads their columns.
template <class Scalar>
void selective(benchmark::State& state) {
  const Problem& p = problem();
  palpate::DenseInverse<Scalar> inverse(p.inverse.llt().solve(MatrixX::Identity(p.size(), p.size())), {});
  VectorX u(p.size());
  for (auto _ : state) {
    inverse.solve_into(p.kept_load, u);
    benchmark::DoNotOptimize(u.data());
  }
  finish(state, p.error_of_kept(u), sizeof(Scalar) == 4 ? 1e-5 : 1e-8,
         3.0 * sizeof(Scalar) * static_cast<double>(p.size()));
}
BENCHMARK_TEMPLATE(selective, double)->Name("selective/DenseInverse<double>")->Unit(benchmark::kMicrosecond);
BENCHMARK_TEMPLATE(selective, float)->Name("selective/DenseInverse<float>")->Unit(benchmark::kMicrosecond);

}  // namespace
