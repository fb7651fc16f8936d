// The prepared solver of a body: made and checked, or read from a cache file and checked.
#pragma once

#include <palpate/model/setup_report.hpp>
#include <palpate/model/solver_recipe.hpp>

#include <optional>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class ElasticBody;
class PreparedCache;

/// What a system is prepared from. Refers to all of it.
struct SystemSource {
  const SolverRecipe& recipe;
  const ElasticBody& body;
  const EssentialConditions& conditions;
  const AnyStiffness& stiffness;
  const std::vector<NodeId>& kept_nodes;
  const DofLayout& dofs;
  const SetupLimits& limits;

  /// The system, measured: flags what lost digits. With a `cache_file` it is read from there, or made and stored there.
  /// Throws what factorisation and checks throw; a cache that is bad or cannot be written is reported and no error.
  AnyStaticSystem prepare(const std::string& cache_file, SetupReport& report) const;

 private:
  AnyStaticSystem prepare_with(const std::string& cache_file, SetupReport& report) const;
  /// The system when the file holds it and a solve with it is right: a last check that trusts no hash. The condition is
  /// as it was measured when the system was made; to measure it again costs as much as to read.
  std::optional<AnyStaticSystem> read(PreparedCache& cache, SetupReport& report) const;
  AnyStaticSystem make(SetupReport& report) const;
  /// Flags or refuses what was measured.
  static void judge(SetupReport& report);

  static constexpr double flagged_probe_error = 1e-6;
  static constexpr double flagged_condition = 1e12;
  static constexpr double refused_probe_error = 1e-3;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/prepared_system.ipp>
#endif
