// The common approach: assemble, solve with Eigen, check info(). No other check.
#include "closed_form.hpp"

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>
#include <Eigen/SparseCore>

namespace maps {
namespace {

template <class Scalar>
using Matrix = Eigen::SparseMatrix<Scalar>;

/// The stiffness, assembled in double for every scalar of the solver.
template <class Scalar>
Matrix<Scalar> assembled(const StaticProblem& problem, const std::vector<Index>& index, Index count) {
  std::vector<Eigen::Triplet<double>> entries;
  add_stiffness<double>(problem, index, [&](Index i, Index j, double value) {
    entries.emplace_back(static_cast<int>(i), static_cast<int>(j), value);
  });
  Matrix<double> k(count, count);
  k.setFromTriplets(entries.begin(), entries.end());
  return k.cast<Scalar>();
}

template <class Scalar, class Solver>
Answer solve_with(const StaticProblem& problem, Solver& solver) {
  Answer answer;
  const auto [index, count] = free_dofs(problem);
  const Matrix<Scalar> k = assembled<Scalar>(problem, index, count);
  solver.compute(k);
  const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> load = load_of(problem, index, count).cast<Scalar>();
  const Eigen::Matrix<Scalar, Eigen::Dynamic, 1> u = solver.solve(load);
  answer.refused = solver.info() != Eigen::Success;
  answer.why = answer.refused ? "info() is not Success" : "";
  answer.displacement = spread(u.template cast<double>(), index);
  return answer;
}

template <class Scalar>
Answer by_ldlt(const StaticProblem& problem) {
  Eigen::SimplicialLDLT<Matrix<Scalar>> solver;
  return solve_with<Scalar>(problem, solver);
}
template <class Scalar>
Answer by_gradients(const StaticProblem& problem) {
  Eigen::ConjugateGradient<Matrix<Scalar>, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(std::is_same_v<Scalar, float> ? Scalar(1e-5) : Scalar(1e-8));
  solver.setMaxIterations(5000);
  return solve_with<Scalar>(problem, solver);
}

}  // namespace

std::vector<StaticSolver> plain_solvers() {
  return {{"Eigen SimplicialLDLT, double", false, 1e-5, by_ldlt<double>},
          {"Eigen ConjugateGradient, double, 1e-8", false, 1e-5, by_gradients<double>},
          {"Eigen SimplicialLDLT, float", false, 1e-3, by_ldlt<float>},
          {"Eigen ConjugateGradient, float, 1e-5", false, 1e-3, by_gradients<float>}};
}

}  // namespace maps
