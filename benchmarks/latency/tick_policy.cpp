// The tick, the set-up and the cost of a new contact, per solver policy.
#include <palpate/linear/dense_cholesky.hpp>
#include <memory>

#include "palpation.hpp"

namespace {

using namespace latency;
using palpate::Condensed;

constexpr Block block = blocks[1];
constexpr double depth = 0.9e-3;

/// Contact force after a fixed path by the reference policy, with which all others are compared.
const palpate::Vector3& reference_force() {
  static const palpate::Vector3 force = [] {
    Palpation<Condensed<palpate::SelectiveInverse>> s(block);
    s.press_to(depth);
    return s.contact_force();
  }();
  return force;
}

/// Allowed relative error of the force. Lazy policies compute no column at set-up, so their compliance floor differs
/// (1 nm/N).
template <class Policy>
constexpr double allowed_error = std::same_as<typename palpate::SolverTraits<Policy>::Scalar, float> ? 1e-5
                                 : palpate::SolverTraits<Policy>::eager                              ? 1e-8
                                                                                                     : 1e-7;

template <class Policy>
void tick(benchmark::State& state) {
  Palpation<Policy> s(block);
  s.press_to(depth);
  const double error = (s.contact_force() - reference_force()).norm() / reference_force().norm();
  sample_ticks(state, [&] { benchmark::DoNotOptimize(s.tick()); });
  s.describe(state);
  state.counters["force_err"] = error;
  if (!(error <= allowed_error<Policy>)) state.SkipWithError("the force differs from that of the reference policy");
  if (!(s.gap_error() < 1e-4)) state.SkipWithError("the pressed points are not on the sphere");
}

/// Lazy policies solve three times for a vertex touched for the first time. The storage is limited to eight vertices,
/// so that every request is a new one.
template <class Policy>
void new_column(benchmark::State& state) {
  palpate::SetupOptions few_slots;
  few_slots.compliance_slots = 8;
  few_slots.columns = palpate::ColumnFill::synchronous;
  Palpation<Policy> s(block, few_slots);
  const int vertices = s.model().contact_surface().vertex_count();
  int v = 0;
  palpate::Status status;
  for (auto _ : state) {
    v = (v + 37) % vertices;
    status |= s.model().require_columns({&v, 1});
  }
  const palpate::Matrix3 c = s.model().compliance(v, v);
  if (!status.ok() || !(c.diagonal().minCoeff() > 0.0) || !(c - c.transpose()).isZero(1e-8 * c.norm()))
    state.SkipWithError("the compliance is wrong");
}

#define PALPATE_POLICY(title, ...) BENCHMARK_TEMPLATE(tick, __VA_ARGS__)->Name("tick/policy/" title)->Apply(as_ticks)
#define PALPATE_LAZY_POLICY(title, ...) \
  PALPATE_POLICY(title, __VA_ARGS__);   \
  BENCHMARK_TEMPLATE(new_column, __VA_ARGS__)->Name("new_vertex/" title)->Unit(benchmark::kMicrosecond)

PALPATE_POLICY("Condensed<SelectiveInverse>", Condensed<palpate::SelectiveInverse>);
PALPATE_POLICY("Condensed<SelectiveInverseFloat>", Condensed<palpate::SelectiveInverseFloat>);
PALPATE_LAZY_POLICY("Condensed<DenseCholesky>", Condensed<palpate::DenseCholesky>);
PALPATE_LAZY_POLICY("SparseCholesky", palpate::SparseCholesky);
PALPATE_LAZY_POLICY("ConjugateGradient", palpate::ConjugateGradient);

}  // namespace
