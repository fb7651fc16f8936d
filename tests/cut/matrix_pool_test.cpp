#include <palpate/cut/detail/matrix_pool.hpp>

#include "catch.hpp"

using namespace palpate;

TEST_CASE("a pool reuses only matrices without readers", "[cut]") {
  detail::MatrixPool pool;
  pool.prepare(10, 2);
  auto a = pool.take(10), b = pool.take(10), c = pool.take(10);
  CHECK(a != b);
  CHECK(a != c);
  CHECK(b != c);
  REQUIRE(c->rows() >= 10);
  const std::shared_ptr<const MatrixX> read = b;
  const MatrixX* const first = a.get();
  a.reset();
  b.reset();
  CHECK(pool.take(11).get() == first);  // there is spare capacity
  a = pool.take(11);
  CHECK(pool.take(11) != read);
  const auto large = pool.take(1000);
  CHECK(large->rows() >= 1000);
  CHECK(large->cols() == large->rows());
}
