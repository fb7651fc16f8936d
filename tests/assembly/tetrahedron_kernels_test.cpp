// The kernels of batched tetrahedra for every processor against one tetrahedron at a time.
#include <palpate/assembly/detail/tetrahedron_kernels.hpp>
#include <palpate/assembly/detail/tetrahedron_kernels_here.hpp>
#include <palpate/testing/random.hpp>

#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include "catch.hpp"
#include "kernels_of_processors.hpp"

using namespace palpate;
using any_flags::TetrahedronKernels;

namespace {

/// Those that this processor can execute.
test::NamedKernels<TetrahedronKernels> executable_kernels() {
#if defined(PALPATE_KERNELS_BY_PROCESSOR)
  return test::executable(detail::tetrahedron_kernels(), detail::tetrahedra_here, &any_flags::tetrahedra_avx2,
                          &any_flags::tetrahedra_avx512);
#else
  return test::executable<TetrahedronKernels>(detail::tetrahedron_kernels(), detail::tetrahedra_here, nullptr, nullptr);
#endif
}

/// Batches whose lanes share nodes; the last lane is empty.
template <class S>
struct Block {
  static constexpr int lanes = any_flags::tetrahedra_at_once<S>;
  static constexpr int batch_count = 5, row_count = 37;
  static constexpr double lambda = 700.0, mu = 1100.0;

  std::vector<detail::TetrahedronBatch<S, lanes>> batches{static_cast<std::size_t>(batch_count)};
  std::vector<std::int32_t> nodes;
  std::vector<double> displacement;

  Block() {
    testing::Random random(11);
    for (std::int32_t r = 0; r < row_count; ++r) nodes.push_back((r * 5 + 3) % row_count);
    for (int i = 0; i < 3 * row_count; ++i) displacement.push_back(random.uniform(-0.3, 0.3));
    for (int b = 0; b < batch_count; ++b) {
      detail::TetrahedronBatch<S, lanes>& batch = batches[static_cast<std::size_t>(b)];
      batch = {};
      for (int lane = 0; lane < lanes; ++lane) {
        for (int a = 0; a < 4; ++a)
          batch.row[a][lane] = static_cast<std::uint16_t>(4 * ((7 * b + 3 * lane + 9 * a) % row_count));
        if (b + 1 == batch_count && lane + 1 == lanes) continue;
        for (Triple<detail::Lanes<S, lanes>>& g : batch.gradient)
          for (detail::Lanes<S, lanes>* x : {&g.x, &g.y, &g.z}) x->set(lane, static_cast<S>(random.uniform(-1.0, 1.0)));
        batch.volume.set(lane, static_cast<S>(random.uniform(0.5, 1.0)));
      }
    }
  }

  struct Result {
    std::vector<double> rows;
    std::array<std::vector<double>, 4> volumes;  ///< smallest, batch, upright, broken
  };

  Result computed(const TetrahedronKernels& kernels) const {
    std::vector<S> rows(4 * row_count, S(0)), volumes(4 * lanes, S(-7));
    kernels.neo_hookean({batches.data(), batch_count, nodes.data(), row_count, displacement.data(), rows.data(),
                         S(lambda), S(mu), volumes.data()});
    Result r{{rows.begin(), rows.end()}, {}};
    for (int k = 0; k < 4; ++k)
      r.volumes[static_cast<std::size_t>(k)].assign(volumes.begin() + k * lanes, volumes.begin() + (k + 1) * lanes);
    return r;
  }

  Result expected() const {
    const auto zeros = std::vector<double>(static_cast<std::size_t>(lanes), 0.0);
    Result r{std::vector<double>(4 * row_count, 0.0),
             {std::vector<double>(static_cast<std::size_t>(lanes), infinity), zeros, zeros, zeros}};
    for (int b = 0; b < batch_count; ++b)
      for (int lane = 0; lane < lanes; ++lane) add(b, lane, r);
    return r;
  }

 private:
  void add(int b, int lane, Result& r) const {
    const detail::TetrahedronBatch<S, lanes>& batch = batches[static_cast<std::size_t>(b)];
    const auto at = static_cast<std::size_t>(lane);
    const auto u = [&](int a, int c) {
      const auto node = static_cast<std::size_t>(nodes[std::size_t{batch.row[a][lane]} / 4]);
      return displacement[3 * node + static_cast<std::size_t>(c)];
    };
    Tensor3<double> f = Tensor3<double>::identity();
    Triple<double> g[3];
    for (int a = 0; a < 3; ++a) {
      const auto& lanes_of = batch.gradient[a];
      g[a] = {static_cast<double>(lanes_of.x[lane]), static_cast<double>(lanes_of.y[lane]),
              static_cast<double>(lanes_of.z[lane])};
      f = f + outer({u(a + 1, 0) - u(0, 0), u(a + 1, 1) - u(0, 1), u(a + 1, 2) - u(0, 2)}, g[a]);
    }
    const double volume = static_cast<double>(batch.volume[lane]), j = determinant(f);
    const Tensor3<double> p = volume * (mu * f + ((lambda + mu) * j - (lambda + 2.0 * mu)) * cofactor(f));
    for (int a = 0; a < 3; ++a) {
      const Triple<double> force = p * g[a];
      const double of[3] = {force.x, force.y, force.z};
      for (std::size_t c = 0; c < 3; ++c) {
        r.rows[std::size_t{batch.row[a + 1][lane]} + c] += of[c];
        r.rows[std::size_t{batch.row[0][lane]} + c] -= of[c];
      }
    }
    if (volume > 0.0 && j < r.volumes[0][at]) {
      r.volumes[0][at] = j;
      r.volumes[1][at] = b;
    }
    r.volumes[2][at] += volume > 0.0 ? j > 0.0 : 1.0;
  }
};

double largest(const std::vector<double>& v) {
  double most = 0.0;
  for (const double x : v) most = std::max(most, std::abs(x));
  return most;
}
double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double most = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) most = std::max(most, std::abs(a[i] - b[i]));
  return most;
}

}  // namespace

TEMPLATE_TEST_CASE("The kernels of every processor compute neo-Hookean forces and volumes", "[assembly][batched]",
                   double, float) {
  const Block<TestType> block;
  const auto exact = block.expected();
  const double tolerance = sizeof(TestType) == 8 ? 1e-14 : 5e-6;
  for (const auto& [name, kernels] : executable_kernels()) {
    INFO(name);
    const auto got = block.computed(*kernels);
    CHECK(difference(got.rows, exact.rows) <= tolerance * largest(exact.rows));
    CHECK(difference(got.volumes[0], exact.volumes[0]) <= tolerance * largest(exact.volumes[0]));
    for (std::size_t k = 1; k < 4; ++k) CHECK(got.volumes[k] == exact.volumes[k]);
  }
}
