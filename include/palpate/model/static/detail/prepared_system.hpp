// The prepared solver of a body: made and checked, or read from a cache file and checked.
#pragma once

#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/static/detail/any_static_system.hpp>

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryReader;
class ElasticBody;
class PreparedCache;
class FreeStiffness;
struct EssentialConditions;

/// A solver policy without its type: its functions and constants. See solver_recipe.
struct SolverRecipe {
  std::string_view cache_name;  ///< empty: its systems cannot be stored
  std::size_t scalar_bytes = sizeof(double);
  bool eager = false;                ///< all compliance is computed at set-up
  bool estimates_condition = false;  ///< a few more solves are cheap
  AnyStaticSystem (*make)(const AnyStiffness&, const EssentialConditions&, const DofLayout&, const SetupLimits&);
  /// Null when its systems cannot be stored. Takes the stored matrix.
  AnyStaticSystem (*read)(BinaryReader&, const BlockMatrix&, const EssentialConditions&, const DofLayout&,
                          const SetupLimits&);
};

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
  /// Refuses a system whose softest motion is lost in rounding: a mechanism that geometry does not show, or as good as
  /// one. Asked only where digits are missing.
  void require_softest_motion(const FreeStiffness& free, AnyStaticSystem& system, const SetupReport& report) const;

  static constexpr double flagged_probe_error = 1e-6;
  static constexpr double flagged_condition = 1e12;
  static constexpr double refused_probe_error = 1e-3;
  static constexpr double refused_softest_error = 0.1;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/prepared_system.ipp>
#endif
