// Dense products and inverses by several threads.
#include "catch.hpp"

#include <palpate/linear/detail/dense_kernels.hpp>
#include <palpate/linear/detail/spd_inverse.hpp>
#include <palpate/testing/random.hpp>

#include <cmath>
#include <cstring>
#include <vector>

#include "linear/large_case.hpp"

using namespace palpate;
using namespace test;
using detail::Operand;
using detail::Read;

namespace {

MatrixX random_values(Index rows, Index columns) {
  testing::Random random(static_cast<std::uint64_t>(rows * columns));
  MatrixX m(rows, columns);
  for (Index i = 0; i < m.size(); ++i) m.data()[i] = random.uniform(-1.0, 1.0);
  return m;
}

bool same_bits(const MatrixX& a, const MatrixX& b) {
  return a.size() == b.size() &&
         std::memcmp(a.data(), b.data(), sizeof(double) * static_cast<std::size_t>(a.size())) == 0;
}

/// A product with the given kinds of operands. Of a symmetric operand only the lower half is finite.
struct Product {
  Read left, right;
  bool lower;
};
constexpr Index rows = 517, columns = 733, depth = 301;

MatrixX operand(Read read, Index n, Index k) {
  if (read == Read::transposed) return random_values(k, n);
  MatrixX m = random_values(n, k);
  if (read == Read::symmetric) m.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));
  return m;
}
MatrixX as_read(Read read, const MatrixX& m) {
  if (read == Read::plain) return m;
  if (read == Read::transposed) return m.transpose();
  return m.selfadjointView<Eigen::Lower>();
}

MatrixX add(const Product& p, const MatrixX& a, const MatrixX& b, const SetupThreads& threads) {
  const Index n = as_read(p.left, a).rows(), k = as_read(p.right, b).cols();
  MatrixX c = random_values(n, k);
  detail::add_product({c.data(), n, k, n, p.lower}, -0.5, {a.data(), a.rows(), p.left}, {b.data(), b.rows(), p.right},
                      as_read(p.left, a).cols(), threads);
  return c;
}

}  // namespace

TEST_CASE("a dense product has the same bits for any number of threads", "[linear][threads]") {
  const std::vector<Product> products{{Read::plain, Read::plain, false},     {Read::plain, Read::transposed, false},
                                      {Read::transposed, Read::plain, true}, {Read::plain, Read::transposed, true},
                                      {Read::symmetric, Read::plain, false}, {Read::plain, Read::symmetric, false}};
  for (const Product& p : products) {
    const Index n = p.left == Read::symmetric ? depth : rows;
    const Index k = p.right == Read::symmetric ? depth : p.lower ? n : columns;
    const MatrixX a = operand(p.left, n, depth), b = operand(p.right, depth, k);
    const MatrixX one = add(p, a, b, 1);
    MatrixX expected = random_values(n, k) - 0.5 * as_read(p.left, a) * as_read(p.right, b);
    if (p.lower) expected.triangularView<Eigen::StrictlyUpper>() = random_values(n, k);
    CHECK((one - expected).cwiseAbs().maxCoeff() < 1e-12);
    for (const int threads : {2, 3, 7}) CHECK(same_bits(add(p, a, b, threads), one));
  }
}

TEST_CASE("an inverse has the same bits for any number of threads", "[linear][threads]") {
  const MatrixX factor = random_values(900, 900);
  const MatrixX matrix = factor * factor.transpose() + 10.0 * MatrixX::Identity(900, 900);
  const auto inverse = [&](const SetupThreads& threads) {
    MatrixX m = matrix;
    detail::SpdInverse::invert(m, 1e-15, "not positive definite", threads);
    return m;
  };
  const MatrixX one = inverse(1);
  CHECK((one * matrix - MatrixX::Identity(900, 900)).cwiseAbs().maxCoeff() < 1e-9);
  for (const int threads : {2, 3, 7}) CHECK(same_bits(inverse(threads), one));
  OneByOne serial;
  CHECK(same_bits(inverse(serial), one));
}
