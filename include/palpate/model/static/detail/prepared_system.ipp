// Definitions of prepared_system.hpp.
#pragma once

#include <palpate/model/static/detail/prepared_system.hpp>

#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/linear/condition.hpp>
#include <palpate/model/cache/cache_file.hpp>
#include <palpate/model/detail/stage_timer.hpp>
#include <palpate/model/static/detail/checking_solver.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE AnyStaticSystem SystemSource::prepare(const CacheFile& cache_file, SetupReport& report) const {
  if (!cache_file.empty()) {
    if (recipe.read != nullptr) return cache_file.prepare(*this, report);
    report.cache.file = cache_file.name();
    report.cache.supported = false;
  }
  return make(report);
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
