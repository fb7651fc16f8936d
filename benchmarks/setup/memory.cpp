// Memory predicted by the analysis compared with the growth of the resident memory, and the refusal above a limit.
#include "../common/bodies.hpp"
#include "setup.hpp"

namespace setup {
namespace {

using namespace palpate;

void compare(Session& session, const std::string& what, double predicted, double measured) {
  if (std::isnan(measured)) return session.rows.skip("g", what, "this system does not report the memory of a process");
  // The larger of both ratios: predicting too much is as wrong as predicting too little.
  session.rows.add({.target = "g",
                    .what = what,
                    .figure = bench::megabytes(predicted),
                    .baseline = bench::megabytes(measured),
                    .ratio = std::max(predicted / measured, measured / predicted),
                    .bound = bench::at_most(1.1),
                    .error = ""});
}

/// 1 when a limit just below the prediction is refused as too large, and one just above is accepted.
double refusal(const bench::System& system, const detail::CholeskyAnalysis& analysis) {
  SetupLimits limits;
  limits.memory = static_cast<std::size_t>(1.01 * analysis.peak_bytes());
  const SparseCholesky fits(analysis, system.lower, limits);
  limits.memory = static_cast<std::size_t>(0.99 * analysis.peak_bytes());
  try {
    const SparseCholesky does_not(analysis, system.lower, limits);
  } catch (const SetupError& e) {
    return e.kind() == SetupErrorKind::too_large ? 1.0 : 0.0;
  }
  return 0.0;
}

}  // namespace

void measure_memory(Session& session) {
  for (const int n : {16, 24}) {
    const bench::System system(bench::standard_block(n));
    const detail::CholeskyAnalysis plain(system.lower, system.layout), keeping(system.lower, system.keeping_patch());
    const double whole = bench::peak_growth([&] { const SparseCholesky f(plain, system.lower, SetupLimits{}); });
    const double patch = bench::peak_growth([&] {
      MatrixX schur;
      const auto f = SparseCholesky::interior(keeping, system.lower, schur, SetupLimits{});
    });
    compare(session, at_size("memory of factorising, predicted / measured", n), plain.peak_bytes(), whole);
    compare(session, at_size("memory of condensing onto the patch, the same", n), keeping.interior_peak_bytes(), patch);
    if (n == 16)
      session.rows.add({.target = "g",
                        .what = "refused as too_large 1 % below the prediction, accepted 1 % above",
                        .figure = "",
                        .baseline = "",
                        .ratio = refusal(system, plain),
                        .bound = bench::at_least(1.0),
                        .error = ""});
  }
}

}  // namespace setup
