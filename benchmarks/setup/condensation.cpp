// Condensation onto a touchable patch compared with the plain factorisation of the same matrix.
#include "../common/bodies.hpp"
#include "setup.hpp"

#include <palpate/condensation/static_systems.hpp>
#include <palpate/linear/dense_cholesky.hpp>

namespace setup {

using namespace palpate;

void measure_condensation(Session& session) {
  for (const int n : {16, 24}) {
    const bench::System system(bench::standard_block(n));
    const detail::CholeskyAnalysis plain(system.lower, system.layout), keeping(system.lower, system.keeping_patch());
    SparseCholesky whole, interior;
    MatrixX schur;
    const auto [condensed, factorised] = bench::medians_in_turns(
        [&] {
          interior = {};
          interior = SparseCholesky::interior(keeping, system.lower, schur, SetupLimits{});
        },
        [&] {
          whole = {};
          whole = SparseCholesky(plain, system.lower, SetupLimits{});
        },
        {.seconds = 3.0, .least = 3, .most = 15});
    const VectorX b = bench::random_matrix(system.lower.rows(), 1);
    VectorX expected(b.size()), x(b.size());
    whole.solve_into(b, expected);
    CondensedSystem solver = CondensedSystem::with<DenseCholesky>({std::move(schur), std::move(interior)}, {});
    solver.solve_into(b, x);
    const std::string what = "onto " + std::to_string(system.patch.size() / 3) + " nodes / plain factorisation";
    session.rows.add(
        {.target = "f",
         .what = at_size(what.c_str(), n),
         .figure = bench::milliseconds(condensed),
         .baseline = bench::milliseconds(factorised),
         .ratio = condensed / factorised,
         .bound = bench::at_most(1.25),
         .error = error_over((x - expected).norm() / expected.norm(), 1e-10, "condensed and full solution differ:")});
  }
}

}  // namespace setup
