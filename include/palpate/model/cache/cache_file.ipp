// Definitions of cache_file.hpp.
#pragma once

#include <palpate/model/cache/cache_file.hpp>

#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/linear/condition.hpp>
#include <palpate/model/cache/detail/prepared_cache.hpp>
#include <palpate/model/detail/elastic_body.hpp>
#include <palpate/model/detail/stage_timer.hpp>
#include <palpate/model/static/detail/checking_solver.hpp>
#include <palpate/model/static/detail/prepared_system.hpp>

#include <optional>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {
namespace detail {

/// Returns the system when the file contains it and a solve with it is right: a final check that does not depend on
/// hashes. The condition number is the one measured when the system was computed; measuring it again would cost as
/// much as reading the file.
inline std::optional<AnyStaticSystem> read_prepared(const SystemSource& source, PreparedCache& cache,
                                                    SetupReport& report) {
  const StageTimer timer(report, "read cache");
  if (!cache.open()) return std::nullopt;
  double condition = 0.0;
  cache.payload().value(condition);
  std::optional<AnyStaticSystem> system(
      source.recipe.read(cache.payload(), *source.stiffness.matrix(), source.conditions, source.dofs, source.limits));
  if (!cache.verify()) return std::nullopt;
  CheckingSolver solver(*system, source.limits);
  const double error = probe_error(FreeStiffness(source.stiffness.view(), source.conditions), solver);
  solver.require_going_on();
  if (!(error <= refused_probe_error)) {
    cache.reject(CacheMismatch::answers, "a solve with a known answer is wrong");
    return std::nullopt;
  }
  report.condition_estimate = condition;
  report.probe_error = error;
  judge_accuracy(source.recipe.iterative, report);
  return system;
}

PALPATE_INLINE AnyStaticSystem prepare_with_cache(const SystemSource& source, const std::string& file,
                                                  SetupReport& report) {
  source.limits.advance("cache", 0.0);
  const CacheKey key = cache_key(source.body.key(), source.conditions, source.kept_nodes, *source.stiffness.matrix(),
                                 source.recipe.cache_name, source.recipe.scalar_bytes);
  PreparedCache cache(file, key, report.cache);
  if (auto system = read_prepared(source, cache, report)) return std::move(*system);
  AnyStaticSystem system = source.make(report);
  source.limits.advance("cache", 0.5);
  const StageTimer timer(report, "write cache");
  cache.store([&](BinaryWriter& out) {
    out.value(report.condition_estimate);
    system.write(out);
  });
  if (report.cache.mismatch != CacheMismatch::none)
    report.set(SetupFlag::cache_rejected, file + " was not used because " + report.cache.why);
  if (!report.cache.written)
    report.set(SetupFlag::cache_unwritten, file + " could not be written because " + report.cache.problem);
  return system;
}

}  // namespace detail

PALPATE_INLINE detail::AnyStaticSystem CacheFile::prepare(const detail::SystemSource& source,
                                                          SetupReport& report) const {
  return prepare_(source, name_, report);
}

}}  // namespace palpate
