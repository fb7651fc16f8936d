// A solver policy without its type: what code that is no template needs of it.
#pragma once

#include <palpate/assembly/any_stiffness.hpp>
#include <palpate/model/any_static_system.hpp>
#include <palpate/model/policies.hpp>

#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

/// The functions and constants of a SolverPolicy.
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

/// The recipe of a policy.
template <SolverPolicy Policy>
constexpr SolverRecipe solver_recipe() noexcept {
  using Traits = SolverTraits<Policy>;
  constexpr bool stored = std::same_as<typename Traits::Assembly, Assembled>;
  SolverRecipe recipe{};
  recipe.scalar_bytes = sizeof(typename Traits::Scalar);
  recipe.eager = Traits::eager;
  recipe.estimates_condition = stored && !std::same_as<Policy, WithAssembly<ConjugateGradient, Assembled>>;
  recipe.make = [](const AnyStiffness& k, const EssentialConditions& conditions, const DofLayout& layout,
                   const SetupLimits& limits) {
    if constexpr (requires(const BlockMatrix& matrix) { Traits::make(matrix, conditions, layout, limits); } && stored)
      return AnyStaticSystem(Traits::make(*k.matrix(), conditions, layout, limits));
    else
      return AnyStaticSystem(Traits::make(k.view(), conditions, layout, limits));
  };
  if constexpr (CacheablePolicy<Policy>) {
    recipe.cache_name = Traits::cache_name;
    recipe.read = [](BinaryReader& in, const BlockMatrix& matrix, const EssentialConditions& conditions,
                     const DofLayout& layout, const SetupLimits& limits) {
      return AnyStaticSystem(Traits::read(in, matrix, conditions, layout, limits));
    };
  }
  return recipe;
}

}}  // namespace palpate
