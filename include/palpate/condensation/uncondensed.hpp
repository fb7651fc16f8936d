// No condensation: every solve uses all free dofs.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/linear/detail/any_solver.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A solver over all free dofs that provides the compliance of a few of them. Each compliance column costs one solve.
/// Satisfies StaticSystem.
class Uncondensed {
 public:
  Uncondensed() = default;
  /// `kept` lists the free dofs whose compliance is needed. Accepts any copyable LinearSolver.
  Uncondensed(AnySolver solver, std::vector<Index> kept);

  /// Writes the solver; writes nothing if the solver cannot be stored.
  void write(BinaryWriter& out) const { solver_.write(out); }

  Index size() const noexcept { return solver_.size(); }
  Index kept() const noexcept { return static_cast<Index>(kept_.size()); }
  std::size_t bytes() const noexcept { return solver_.bytes(); }
  SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads = 1) noexcept {
    return solver_.solve_into(b, x, threads);
  }
  /// Displacements of the kept dofs under a unit force on kept dof j. No allocation.
  SolveReport compliance_column(Index j, VectorX& column) noexcept;

 private:
  AnySolver solver_;
  std::vector<Index> kept_;
  VectorX load_, answer_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/condensation/uncondensed.ipp>
#endif
