// The selective product: displacement of all kept dofs from a few loaded nodes, compared with reading the matrix.
#include "tick.hpp"

#include "../common/machine.hpp"

#include <palpate/linear/dense_inverse.hpp>

namespace tick {
namespace {

using namespace palpate;

/// A well-conditioned symmetric positive definite matrix; its values do not affect the time.
MatrixX some_spd_matrix(Index size) {
  MatrixX m = bench::random_matrix(size, size);
  m = (m + m.transpose()).eval();
  m.diagonal().array() += 4.0 * std::sqrt(static_cast<double>(size));
  return m;
}

/// Every call loads other nodes, so that the whole matrix is read in turn: at the speed of the smallest memory level
/// that holds it.
template <class Scalar>
void measure(bench::RowFile& rows, const MatrixX& stiffness, Index loaded_nodes, const char* scalar) {
  DenseInverse<Scalar> inverse(stiffness, {});
  const Index size = stiffness.rows();
  VectorX load = VectorX::Zero(size), u(size);
  Index first = 0;
  const auto product = [&] {
    for (Index i = 0; i < loaded_nodes; ++i) load.segment<3>(3 * ((first + i) % (size / 3))).setZero();
    first = (first + loaded_nodes) % (size / 3);
    for (Index i = 0; i < loaded_nodes; ++i) load.segment<3>(3 * ((first + i) % (size / 3))) << 0.1, -0.2, 0.3;
    inverse.solve_into(load, u);
  };
  std::vector<double> times, bandwidths;
  const double matrix = static_cast<double>(inverse.bytes());
  for (int round = 0; round < 7; ++round) {
    times.push_back(bench::median_seconds(
                        [&] {
                          for (int i = 0; i < 64; ++i) product();
                        },
                        {.seconds = 0.1, .least = 3, .most = 99}) /
                    64.0);
    bandwidths.push_back(bench::read_bandwidth(matrix, {.seconds = 0.1, .least = 3, .most = 99}));
  }
  const double seconds = bench::percentile(times, 0.5), bandwidth = bench::percentile(bandwidths, 0.5);
  const double rate = 3.0 * static_cast<double>(loaded_nodes * size) * sizeof(Scalar) / seconds;
  const double error = (stiffness * u - load).norm() / load.norm(), allowed = sizeof(Scalar) == 4 ? 1e-5 : 1e-10;
  rows.add({.target = "j",
            .what = "selective product, " + std::to_string(loaded_nodes) + " loaded nodes on " + std::to_string(size) +
                    " dofs, " + scalar,
            .figure = bench::gigabytes_per_second(rate) + " (" + bench::microseconds(seconds) + ")",
            .baseline = bench::gigabytes_per_second(bandwidth) + " at " + bench::megabytes(matrix),
            .ratio = rate / bandwidth,
            .bound = bench::at_least(0.9),
            .error = error <= allowed ? "" : "the displacement is wrong"});
}

}  // namespace

void measure_products(bench::RowFile& rows) {
  for (const Index size : {900, 3747}) {
    const MatrixX stiffness = some_spd_matrix(size);
    measure<double>(rows, stiffness, 30, "double");
    measure<float>(rows, stiffness, 30, "float");
  }
}

}  // namespace tick
