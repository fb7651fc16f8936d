// The unit of compile time: a sparse solve with plain Eigen.
#include <Eigen/Sparse>

#include <iostream>
#include <vector>

int main() {
  constexpr int n = 1000;
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < n; ++i) {
    entries.emplace_back(i, i, 2.0);
    if (i > 0) entries.emplace_back(i, i - 1, -1.0);
  }
  Eigen::SparseMatrix<double> matrix(n, n);
  matrix.setFromTriplets(entries.begin(), entries.end());
  const Eigen::SimplicialLDLT<Eigen::SparseMatrix<double>> solver(matrix);
  const Eigen::VectorXd x = solver.solve(Eigen::VectorXd::Ones(n));
  std::cout << x.maxCoeff() << '\n';
}
