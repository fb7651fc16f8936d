// Definitions of prepared_system.hpp.
#pragma once

#include <palpate/model/static/detail/prepared_system.hpp>

#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/linear/condition.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>
#include <palpate/model/cache/detail/prepared_cache.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>

#include <algorithm>
#include <exception>
#include <limits>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A system as a LinearSolver that solves on the threads of a set-up and reports progress before every solve. After a
/// cancellation it only returns NaN, which ends an estimate; then `require_going_on` throws.
class CheckingSolver {
 public:
  CheckingSolver(AnyStaticSystem& system, const SetupLimits& limits) : system_(system), limits_(limits) {}

  Index size() const noexcept { return system_.size(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    if (goes_on()) return system_.solve_into(b, x, limits_.threads);
    fill(x, std::numeric_limits<double>::quiet_NaN());
    return {false, 0, std::numeric_limits<double>::quiet_NaN()};
  }
  /// Throws what the report of progress has thrown.
  void require_going_on() const {
#if defined(PALPATE_HAS_EXCEPTIONS)
    if (stopped_) std::rethrow_exception(stopped_);
#endif
  }

 private:
  bool goes_on() noexcept {
    constexpr double usual = 8.0;  // solves of all checks
#if defined(PALPATE_HAS_EXCEPTIONS)
    try {
#endif
      if (!stopped_) limits_.advance("checks", std::min(0.9, solves_++ / usual));
#if defined(PALPATE_HAS_EXCEPTIONS)
    } catch (...) {
      stopped_ = std::current_exception();
    }
#endif
    return !stopped_;
  }

  AnyStaticSystem& system_;
  const SetupLimits& limits_;
  std::exception_ptr stopped_;
  int solves_ = 0;
};

PALPATE_INLINE AnyStaticSystem SystemSource::prepare(const std::string& cache_file, SetupReport& report) const {
  if (!cache_file.empty()) {
    if (recipe.read != nullptr) return prepare_with(cache_file, report);
    report.cache.file = cache_file;
    report.cache.supported = false;
  }
  return make(report);
}

PALPATE_INLINE AnyStaticSystem SystemSource::prepare_with(const std::string& cache_file, SetupReport& report) const {
  limits.advance("cache", 0.0);
  const CacheKey key =
      cache_key(body.key(), conditions, kept_nodes, *stiffness.matrix(), recipe.cache_name, recipe.scalar_bytes);
  PreparedCache cache(cache_file, key, report.cache);
  if (auto system = read(cache, report)) return std::move(*system);
  AnyStaticSystem system = make(report);
  limits.advance("cache", 0.5);
  const StageTimer timer(report, "write cache");
  cache.store([&](BinaryWriter& out) {
    out.value(report.condition_estimate);
    system.write(out);
  });
  if (report.cache.mismatch != CacheMismatch::none)
    report.set(SetupFlag::cache_rejected, cache_file + " was not used because " + report.cache.why);
  if (!report.cache.written)
    report.set(SetupFlag::cache_unwritten, cache_file + " could not be written because " + report.cache.problem);
  return system;
}

PALPATE_INLINE std::optional<AnyStaticSystem> SystemSource::read(PreparedCache& cache, SetupReport& report) const {
  const StageTimer timer(report, "read cache");
  if (!cache.open()) return std::nullopt;
  double condition = 0.0;
  cache.payload().value(condition);
  std::optional<AnyStaticSystem> system(recipe.read(cache.payload(), *stiffness.matrix(), conditions, dofs, limits));
  if (!cache.verify()) return std::nullopt;
  CheckingSolver solver(*system, limits);
  const double error = probe_error(FreeStiffness(stiffness.view(), conditions), solver);
  solver.require_going_on();
  if (!(error <= refused_probe_error)) {
    cache.reject(CacheMismatch::answers, "a solve with a known answer is wrong");
    return std::nullopt;
  }
  report.condition_estimate = condition;
  report.probe_error = error;
  judge_accuracy(recipe.iterative, report);
  return system;
}

PALPATE_INLINE AnyStaticSystem SystemSource::make(SetupReport& report) const {
  AnyStaticSystem system = [&] {
    const StageTimer timer(report, "factorisation");
    return recipe.make(stiffness, conditions, dofs, limits);
  }();
  const StageTimer timer(report, "checks");
  const FreeStiffness free(stiffness.view(), conditions);
  estimate_accuracy(free, system, report);
  require_softest_motion(free, system, report);
  judge_accuracy(recipe.iterative, report);
  return system;
}

PALPATE_INLINE void SystemSource::estimate_accuracy(const FreeStiffness& free, AnyStaticSystem& system,
                                                    SetupReport& report) const {
  CheckingSolver solver(system, limits);
  report.probe_error = probe_error(free, solver);
  report.condition_estimate = recipe.iterative
                                  ? condition_by_iteration(free, solver)
                                  : free_norm(*stiffness.matrix(), conditions) * inverse_norm_estimate(solver);
  solver.require_going_on();
}

PALPATE_INLINE void SystemSource::require_softest_motion(const FreeStiffness& free, AnyStaticSystem& system,
                                                         const SetupReport& report) const {
  const bool doubtful = report.probe_error > flagged_probe_error || is_ill_conditioned(report, recipe.iterative);
  if (!doubtful) return;
  CheckingSolver solver(system, limits);
  const SoftestMotion softest = probe_softest_motion(free, solver);
  solver.require_going_on();
  if (!(softest.error > refused_softest_error)) return;
  SetupProblem p;
  p.kind = SetupErrorKind::ill_conditioned;
  p.what = "a solve for the softest motion of the body is wrong by " + number(softest.error) +
           " (relative); the named node moves most in it";
  p.hint = "Look there for a part that is hardly constrained: a mechanism, slivers, or extreme stiffness contrast";
  if (const auto& nodes = dofs.node_of_dof; softest.largest >= 0 && !nodes.empty()) {
    p.ids = {nodes[static_cast<std::size_t>(softest.largest)]};
    p.ids_of = SetupIds::nodes;
    p.count = 1;
  }
  p.value = softest.error;
  p.threshold = refused_softest_error;
  raise(std::move(p));
}

PALPATE_INLINE bool is_ill_conditioned(const SetupReport& report, bool iterative) noexcept {
  return report.condition_estimate > (iterative ? 0.1 : 1.0) * flagged_condition;
}

PALPATE_INLINE void judge_accuracy(bool iterative, SetupReport& report) {
  if (report.probe_error > refused_probe_error) {
    SetupProblem p;
    p.kind = SetupErrorKind::ill_conditioned;
    p.what = "a solve with a known answer is wrong by " + number(report.probe_error) + " (relative)";
    p.hint =
        "Look for slivers, extreme stiffness contrast, or a Poisson ratio at its limit; prefer a direct solver in "
        "double";
    p.value = report.probe_error;
    p.threshold = refused_probe_error;
    raise(std::move(p));
  }
  if (report.probe_error > flagged_probe_error)
    report.set(SetupFlag::ill_conditioned, "a solve with a known answer is wrong by " + number(report.probe_error) +
                                               " (relative): forces are no more accurate than that");
  else if (is_ill_conditioned(report, iterative))
    report.set(SetupFlag::ill_conditioned,
               "the condition of the stiffness is about " + number(report.condition_estimate) +
                   ": a change of parameters in the last digits changes the forces noticeably");
}

}}}  // namespace palpate::detail
