// The dense kernels of every processor against Eigen.
#include <palpate/linear/detail/kernels_here.hpp>
#include <palpate/linear/detail/processor_kernels.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Cholesky>

#include <array>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "kernels_of_processors.hpp"

using namespace palpate;
using any_flags::Kernels;

namespace {

/// Those that this processor can execute.
test::NamedKernels<Kernels> executable_kernels() {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return test::executable(detail::processor_kernels(), detail::kernels_here, &any_flags::kernels_avx2,
                          &any_flags::kernels_avx512);
#else
  return test::executable<Kernels>(detail::processor_kernels(), detail::kernels_here, nullptr, nullptr);
#endif
}

MatrixX random_entries(testing::Random& random, Index rows, Index columns) {
  MatrixX m(rows, columns);
  for (Index i = 0; i < m.size(); ++i) m.data()[i] = random.uniform(-1.0, 1.0);
  return m;
}

MatrixX unpacked(const std::vector<double>& from, const detail::LowerPanels& shape) {
  MatrixX m = MatrixX::Zero(shape.height, shape.columns);
  for (Index j = 0; j < shape.columns; ++j)
    for (Index i = j; i < shape.height; ++i) m(i, j) = from[static_cast<std::size_t>(shape.at(i, j))];
  return m;
}

struct Eliminated {
  MatrixX columns, update;
};

/// The first `pivots` columns of a positive definite matrix, eliminated.
Eliminated eliminate(const Kernels& kernels, const MatrixX& matrix, Index pivots) {
  const Index size = matrix.rows(), rows = size - pivots;
  const auto shape = detail::LowerPanels::of(size, pivots), rest = detail::LowerPanels::of(rows, rows);
  const auto doubles = [](Index n) { return std::vector<double>(static_cast<std::size_t>(n), 0.0); };
  auto front = doubles(shape.size() + 8), update = doubles(rest.size() + 8), values = doubles(size),
       packed = doubles(2 * (size + 64) * detail::LowerPanels::width);
  for (Index j = 0; j < pivots; ++j)
    for (Index i = j; i < size; ++i) front[static_cast<std::size_t>(shape.at(i, j))] = matrix(i, j);
  const VectorX diagonal = matrix.diagonal();
  kernels.factor_front(
      {front.data(), pivots, rows, update.data(), 0, values.data(), diagonal.data(), 1e-12, packed.data(), nullptr});
  return {unpacked(front, shape).topRows(size),
          unpacked(update, rest).topRows(rows).triangularView<Eigen::Lower>().toDenseMatrix()};
}

}  // namespace

TEST_CASE("The kernels of every processor eliminate fronts as Eigen does, small ones and packed ones") {
  testing::Random random(7);
  for (const auto& [pivots, rows] : {std::pair<Index, Index>{3, 0}, {11, 30}, {150, 61}, {301, 403}}) {
    const Index size = pivots + rows;
    const MatrixX a = random_entries(random, size, size);
    const MatrixX matrix = a * a.transpose() + static_cast<double>(size) * MatrixX::Identity(size, size);
    const MatrixX l = matrix.topLeftCorner(pivots, pivots).llt().matrixL();
    const MatrixX below =
        l.triangularView<Eigen::Lower>().solve(matrix.bottomLeftCorner(rows, pivots).transpose()).transpose();
    const MatrixX update = (-below * below.transpose()).triangularView<Eigen::Lower>();
    for (const auto& [name, kernels] : executable_kernels()) {
      INFO(name << ", " << pivots << " pivots, " << rows << " rows");
      const Eliminated got = eliminate(*kernels, matrix, pivots);
      CHECK((got.columns.topRows(pivots) - l).norm() < 1e-13 * l.norm());
      CHECK((got.columns.bottomRows(rows) - below).norm() <= 1e-13 * below.norm());
      CHECK((got.update - update).norm() <= 1e-13 * update.norm());
    }
  }
}

TEST_CASE("The kernels of every processor multiply as Eigen does") {
  testing::Random random(8);
  for (const auto& [rows, columns, depth] : {std::array<Index, 3>{1, 1, 1}, {7, 30, 5}, {250, 90, 170}}) {
    const MatrixX a = random_entries(random, rows, depth), b = random_entries(random, depth, columns),
                  start = random_entries(random, rows, columns), expected = start + 0.5 * a * b;
    for (const auto& [name, kernels] : executable_kernels()) {
      INFO(name << ", " << rows << " x " << depth << " x " << columns);
      MatrixX c = start;
      const any_flags::Target target{c.data(), rows, columns, rows};
      std::vector<double> packed(static_cast<std::size_t>(detail::product_workspace(target, depth)));
      kernels->add_product({target, 0.5, {a.data(), rows}, {b.data(), depth}, depth, packed.data()});
      CHECK((c - expected).norm() < 1e-14 * expected.norm() * static_cast<double>(depth));
    }
  }
}

TEST_CASE("The kernels of every processor substitute blocks of right-hand sides as Eigen does") {
  testing::Random random(9);
  for (const Index pivots : {5, 40, 200}) {
    const auto shape = detail::LowerPanels::of(pivots, pivots);
    MatrixX l = random_entries(random, pivots, pivots).triangularView<Eigen::StrictlyLower>();
    l = l / static_cast<double>(pivots) + MatrixX::Identity(pivots, pivots);
    std::vector<double> panels(static_cast<std::size_t>(shape.size() + 8), 0.0);
    for (Index j = 0; j < pivots; ++j)
      for (Index i = j; i < pivots; ++i) panels[static_cast<std::size_t>(shape.at(i, j))] = l(i, j);
    for (const auto& [name, kernels] : executable_kernels())
      for (std::size_t packets = 1; packets <= 3; ++packets) {
        INFO(name << ", " << pivots << " pivots, " << packets << " packets");
        using Rows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
        const Index width = static_cast<Index>(packets) * kernels->packet_size;
        Rows x = Rows::Zero(shape.height + 8, width);
        x.topRows(pivots) = random_entries(random, pivots, width);
        const Rows given = x;
        const auto lower = l.triangularView<Eigen::Lower>();
        const MatrixX transposed = l.transpose();
        const auto upper = transposed.triangularView<Eigen::Upper>();
        kernels->forward[packets - 1](panels.data(), shape.height, pivots, x.data());
        CHECK((x.topRows(pivots) - lower.solve(MatrixX(given.topRows(pivots)))).norm() < 1e-13 * x.norm());
        x = given;
        kernels->backward[packets - 1](panels.data(), shape.height, pivots, x.data());
        CHECK((x.topRows(pivots) - upper.solve(MatrixX(given.topRows(pivots)))).norm() < 1e-13 * x.norm());
      }
  }
}

TEST_CASE("The kernels of every processor add columns of floats in double") {
  constexpr Index count = any_flags::columns_at_once;
  testing::Random random(10);
  for (const Index rows : {0, 1, 15, 16, 37, 900}) {
    const Eigen::MatrixXf matrix = random_entries(random, rows, count).cast<float>();
    const MatrixX loads = random_entries(random, count, 1), start = random_entries(random, rows, 1);
    const VectorX expected = start + matrix.cast<double>() * loads;
    std::array<const float*, count> columns{};
    for (Index k = 0; k < count; ++k) columns[static_cast<std::size_t>(k)] = matrix.data() + k * rows;
    for (const auto& [name, kernels] : executable_kernels()) {
      INFO(name << ", " << rows << " rows");
      VectorX x = start;
      kernels->add_float_columns(columns.data(), loads.data(), rows, x.data());
      CHECK((x - expected).norm() <= 1e-15 * static_cast<double>(count) * expected.norm());
    }
  }
}
