// The recipe of a solver policy, and of the stiffness of its model.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/detail/any_stiffness.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/condensation/static_systems.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/model/detail/element_body.hpp>
#include <palpate/model/policies.hpp>
#include <palpate/model/static/detail/prepared_system.hpp>

#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

// Definitions of policies.hpp, placed here because the system types are complete here.
template <class AssemblyPolicy>
Uncondensed SolverTraits<WithAssembly<ConjugateGradient, AssemblyPolicy>>::make(const StiffnessView& k,
                                                                                const EssentialConditions& conditions,
                                                                                const DofLayout& layout,
                                                                                const SetupLimits&) {
  return detail::make_iterative(k, conditions, layout);
}
template <std::floating_point S>
Uncondensed SolverTraits<BasicSelectiveInverse<S>>::make(const BlockMatrix& k, const EssentialConditions& conditions,
                                                         const DofLayout& layout, const SetupLimits& limits) {
  return detail::make_inverse<S>(k, conditions, layout, limits);
}
template <std::floating_point S>
Uncondensed SolverTraits<BasicSelectiveInverse<S>>::read(BinaryReader& in, const BlockMatrix&,
                                                         const EssentialConditions& conditions, const DofLayout& layout,
                                                         const SetupLimits& limits) {
  return detail::read_inverse<S>(in, conditions, layout, limits);
}
template <class Inner>
CondensedSystem SolverTraits<Condensed<Inner>>::make(const BlockMatrix& k, const EssentialConditions& conditions,
                                                     const DofLayout& layout, const SetupLimits& limits) {
  return detail::make_condensed<typename detail::CondensedTraits<Inner>::Dense>(k, conditions, layout, limits);
}
template <class Inner>
CondensedSystem SolverTraits<Condensed<Inner>>::read(BinaryReader& in, const BlockMatrix& k,
                                                     const EssentialConditions& conditions, const DofLayout& layout,
                                                     const SetupLimits& limits) {
  return detail::read_condensed<typename detail::CondensedTraits<Inner>::Dense>(in, k, conditions, layout, limits);
}

namespace detail {

template <class Policy>
inline constexpr bool is_iterative = std::same_as<Policy, ConjugateGradient>;
template <class Assembly>
inline constexpr bool is_iterative<WithAssembly<ConjugateGradient, Assembly>> = true;

/// The stiffness of a body whose element type is known here only.
template <Element E, class Assembly>
AnyStiffness make_stiffness(const ElasticBody& body, const SetupLimits& limits) {
  return AnyStiffness(Assembly::make(body_of<E>(body), limits));
}

/// The recipe of a policy.
template <SolverPolicy Policy>
constexpr SolverRecipe solver_recipe() noexcept {
  using Traits = SolverTraits<Policy>;
  constexpr bool stored = std::same_as<typename Traits::Assembly, Assembled>;
  SolverRecipe recipe{};
  recipe.scalar_bytes = sizeof(typename Traits::Scalar);
  recipe.eager = Traits::eager;
  recipe.iterative = is_iterative<Policy>;
  recipe.make = [](const AnyStiffness& k, const EssentialConditions& conditions, const DofLayout& layout,
                   const SetupLimits& limits) {
    if constexpr (stored)
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

}  // namespace detail

}}  // namespace palpate
