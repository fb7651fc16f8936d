// No condensation: every solve uses all free dofs.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

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

static_assert(StaticSystem<Uncondensed>);

inline Uncondensed::Uncondensed(AnySolver solver, std::vector<Index> kept)
    : solver_(std::move(solver)),
      kept_(std::move(kept)),
      load_(detail::zeros(solver_.size())),
      answer_(solver_.size()) {}

inline SolveReport Uncondensed::compliance_column(Index j, VectorX& column) noexcept {
  const Index loaded = kept_[static_cast<std::size_t>(j)];
  const double unit = 1.0;
  if (solver_.solve_path_into({&loaded, 1}, {&unit, 1}, kept_, {column.data(), kept_.size()}))
    return {true, 0, std::numeric_limits<double>::quiet_NaN()};
  load_.data()[loaded] = 1.0;
  const SolveReport report = solver_.solve_into(load_, answer_);
  load_.data()[loaded] = 0.0;
  for (std::size_t i = 0; i < kept_.size(); ++i) column.data()[i] = answer_.data()[kept_[i]];
  return report;
}

}}  // namespace palpate
