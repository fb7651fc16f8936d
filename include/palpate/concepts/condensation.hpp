// Concept of a prepared static system: displacement under any load, and compliance of the kept dofs.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A prepared static system over the free dofs with some of them kept. `solve_into` gives the exact displacement under
/// any load (loads on condensed dofs included); `compliance_column(j, c)` writes the response of the kept dofs to a
/// unit force on kept dof j. Neither allocates. Law (testing/condensation_laws.hpp): both equal the full solve.
template <class S>
concept StaticSystem = LinearSolver<S> && requires(S& system, Index j, VectorX& column) {
  { system.kept() } -> std::convertible_to<Index>;
  { system.compliance_column(j, column) } noexcept -> std::same_as<SolveReport>;
  { system.bytes() } -> std::convertible_to<std::size_t>;
};

}}  // namespace palpate
