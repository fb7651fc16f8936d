// The prepared solver of a body: made and checked, or read from a cache file and checked.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/concepts/condensation.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/condition.hpp>
#include <palpate/linear/node_graph.hpp>
#include <palpate/linear/tile.hpp>
#include <palpate/model/cache_key.hpp>
#include <palpate/model/cache_report.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/prepared_cache.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/stage_timer.hpp>

#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// What a system is prepared from. Refers to all of it.
template <Element E, SolverPolicy Policy>
struct SystemSource {
  using Traits = SolverTraits<Policy>;
  using Stiffness = typename Traits::Assembly::template Operator<E>;
  using System = decltype(Traits::make(std::declval<const Stiffness&>(), std::declval<const EssentialConditions&>(),
                                       DofLayout{}, SetupLimits{}));
  static_assert(StaticSystem<System>);

  const Body<E>& body;
  const EssentialConditions& conditions;
  const Stiffness& stiffness;
  const std::vector<NodeId>& kept_nodes;
  const DofLayout& dofs;
  const SetupLimits& limits;

  /// The system, measured: flags what lost digits. With a `cache_file` it is read from there, or made and stored there.
  /// Throws what factorisation and checks throw; a cache that is bad or cannot be written is reported and no error.
  System prepare(const std::string& cache_file, SetupReport& report) const {
    if constexpr (CacheablePolicy<Policy>) {
      if (!cache_file.empty()) return prepare_with(cache_file, report);
    } else if (!cache_file.empty()) {
      report.cache.file = cache_file;
      report.cache.supported = false;
    }
    return make(report);
  }

 private:
  System prepare_with(const std::string& cache_file, SetupReport& report) const {
    limits.advance("cache", 0.0);
    const CacheKey key =
        cache_key<E>(body, conditions, kept_nodes, stiffness, Traits::cache_name, sizeof(typename Traits::Scalar));
    PreparedCache cache(cache_file, key, report.cache);
    if (auto system = read(cache, report)) return std::move(*system);
    System system = make(report);
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

  /// The system when the file holds it and a solve with it is right: a last check that trusts no hash. The condition is
  /// as it was measured when the system was made; to measure it again costs as much as to read.
  std::optional<System> read(PreparedCache& cache, SetupReport& report) const {
    const StageTimer timer(report, "read cache");
    if (!cache.open()) return std::nullopt;
    double condition = 0.0;
    cache.payload().value(condition);
    std::optional<System> system(Traits::read(cache.payload(), stiffness, conditions, dofs, limits));
    if (!cache.verify()) return std::nullopt;
    const double error = probe_error(FreeStiffness<Stiffness>(stiffness, conditions), *system);
    if (!(error <= refused_probe_error)) {
      cache.reject(CacheMismatch::answers, "a solve with a known answer is wrong");
      return std::nullopt;
    }
    report.condition_estimate = condition;
    report.probe_error = error;
    judge(report);
    return system;
  }

  System make(SetupReport& report) const {
    System system = [&] {
      const StageTimer timer(report, "factorisation");
      return Traits::make(stiffness, conditions, dofs, limits);
    }();
    const StageTimer timer(report, "checks");
    limits.advance("checks", 0.0);
    report.probe_error = probe_error(FreeStiffness<Stiffness>(stiffness, conditions), system);
    if constexpr (std::same_as<Stiffness, BlockMatrix>)
      if constexpr (!std::same_as<Policy, WithAssembly<ConjugateGradient, Assembled>>)
        report.condition_estimate = free_norm(stiffness, conditions) * inverse_norm_estimate(system);
    judge(report);
    return system;
  }

  /// Flags or refuses what was measured.
  static void judge(SetupReport& report) {
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
                                                 " (relative): forces keep no more digits than that");
    else if (report.condition_estimate > flagged_condition)
      report.set(SetupFlag::ill_conditioned, "the condition of the stiffness is about " +
                                                 number(report.condition_estimate) +
                                                 ": parameters that differ in the last digits give other forces");
  }

  static constexpr double flagged_probe_error = 1e-6;
  static constexpr double flagged_condition = 1e12;
  static constexpr double refused_probe_error = 1e-3;
};

}}  // namespace palpate
