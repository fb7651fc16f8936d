// The prepared solver of a body: computed or read from a cache file, and checked.
#pragma once

#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/model/setup_report.hpp>

#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryReader;
class CacheFile;
class ElasticBody;
namespace detail {

class FreeStiffness;

}  // namespace detail
struct EssentialConditions;

namespace detail {

/// The type-erased functions and constants of a solver policy. See solver_recipe.
struct SolverRecipe {
  std::string_view cache_name;  ///< empty: its systems cannot be stored
  std::size_t scalar_bytes = sizeof(double);
  bool eager = false;      ///< all compliance is computed at set-up
  bool iterative = false;  ///< every solve is expensive: the condition is estimated from fewer
  AnyStaticSystem (*make)(const AnyStiffness&, const EssentialConditions&, const DofLayout&, const SetupLimits&);
  /// Null when its systems cannot be stored. The matrix is the assembled stiffness.
  AnyStaticSystem (*read)(BinaryReader&, const BlockMatrix&, const EssentialConditions&, const DofLayout&,
                          const SetupLimits&);
};

/// Input for the preparation of a system. Keeps references to all of it.
struct SystemSource {
  const SolverRecipe& recipe;
  const ElasticBody& body;
  const EssentialConditions& conditions;
  const AnyStiffness& stiffness;
  const std::vector<NodeId>& kept_nodes;
  const DofLayout& dofs;
  const SetupLimits& limits;

  /// Prepares the system and checks its accuracy; flags a loss of digits. With a `cache_file` the system is read from
  /// it, or computed and stored in it. Throws the errors of factorisation and checks; a cache that is invalid or cannot
  /// be written is reported and is not an error.
  AnyStaticSystem prepare(const CacheFile& cache_file, SetupReport& report) const;
  /// The same without a file.
  AnyStaticSystem make(SetupReport& report) const;

 private:
  void estimate_accuracy(const FreeStiffness& free, AnyStaticSystem& system, SetupReport& report) const;
  /// Refuses a system whose softest motion is lost in rounding: a mechanism or near-mechanism that the geometric check
  /// does not find. Only checked when digits are lost.
  void require_softest_motion(const FreeStiffness& free, AnyStaticSystem& system, const SetupReport& report) const;

  static constexpr double refused_softest_error = 0.1;
};

inline constexpr double flagged_probe_error = 1e-6, flagged_condition = 1e12, refused_probe_error = 1e-3;

/// Whether the estimate of the condition is large. An estimate by iteration is a lower bound in the 2-norm, usually
/// within a factor 10.
bool is_ill_conditioned(const SetupReport& report, bool iterative) noexcept;
/// Flags a system by its measured accuracy, or throws ill_conditioned.
void judge_accuracy(bool iterative, SetupReport& report);

}  // namespace detail

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/prepared_system.ipp>
#endif
