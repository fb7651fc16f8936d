// Direct solver for sparse symmetric positive definite systems: multifrontal, nested dissection.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/front_reduction.hpp>
#include <palpate/linear/detail/front_sweeps.hpp>

#include <span>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryReader;
class BinaryWriter;
namespace detail {
class ParallelFronts;
}

/// K = L L^T of a sparse SPD matrix, with every pivot checked. Factorisation allocates what the analysis predicted; it
/// uses the threads of the limits, and the factor is the same to the last bit for any number of threads.
/// `solve_into` reads every entry of L twice and does not allocate. Copies share the factor; each owns its workspace,
/// so two threads can solve simultaneously with a copy each.
///
/// An *interior* factor stops before the kept dofs of its analysis and returns their Schur complement instead. Solve
/// with it in three steps: `eliminate_into` condenses a load onto the kept dofs, the caller solves there, and
/// `recover_into` computes the other dofs.
class SparseCholesky {
 public:
  using Matrix = detail::SparseLower;
  /// Smallest pivot allowed, relative to its own diagonal entry. Rounding turns the zero pivots of a free body into
  /// values that start at 1e-15 and grow with the mesh; a supported beam 3000 times as long as thick still has 1e-12.
  static constexpr double pivot_threshold = 1e-13;

  SparseCholesky() = default;

  /// Analyses and factorises the matrix, given by its lower half. Throws not_positive_definite, too_large or
  /// cancelled.
  SparseCholesky(const Matrix& lower, const SetupLimits& limits);

  /// Factorises new values on an analysed pattern. Throws as above, and bad_argument for a different pattern.
  SparseCholesky(detail::CholeskyAnalysis analysis, const Matrix& lower, const SetupLimits& limits);

  /// Factorises all but the kept dofs and writes their exact Schur complement K_kk - K_ki K_ii^-1 K_ik, symmetric to
  /// the last bit, in the given order of the kept dofs [kept x kept]. Costs one factorisation. Throws as above.
  static SparseCholesky interior(detail::CholeskyAnalysis analysis, const Matrix& lower, MatrixX& schur,
                                 const SetupLimits& limits);

  /// Writes the numbers of the factor. The structure is recomputed by analysis, so a file contains no indices.
  void write(BinaryWriter& out) const;
  /// Reads what `write` stored of a complete (or interior) factor of a matrix with this analysis. Valid only when the
  /// reader is good. Throws too_large.
  static SparseCholesky read(BinaryReader& in, detail::CholeskyAnalysis analysis, bool interior,
                             const SetupLimits& limits);

  Index size() const noexcept;
  /// Number of kept dofs that were not eliminated; 0 for a complete factor.
  Index kept() const noexcept;
  const detail::CholeskyAnalysis& analysis() const noexcept;
  Index factor_nonzeros() const noexcept;
  std::size_t bytes() const noexcept;

  /// x = K^-1 b; b and x may be the same vector. An interior factor sets the kept dofs to zero. In a set-up, several
  /// threads read a large factor faster: allocates then, and gives the same bits. So do the functions below.
  SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads = 1) noexcept;

  /// Solves for several right-hand sides. Allocates a workspace; for set-up.
  MatrixX solve(const MatrixX& b) const;

  /// Interior factor: kept_load = b_k - K_ki K_ii^-1 b_i; stores b_i for `recover_into`. No allocation when kept_load
  /// has its size.
  void eliminate_into(const VectorX& b, VectorX& kept_load, const SetupThreads& threads = 1) noexcept;
  /// Interior factor: x from the kept part of the solution and the load of the last `eliminate_into`. No allocation
  /// when x has its size.
  void recover_into(const VectorX& kept_answer, VectorX& x, const SetupThreads& threads = 1) noexcept;
  /// `recover_into` without a load; needs no `eliminate_into` before.
  void extend_into(const VectorX& kept_answer, VectorX& x) noexcept;

  /// Interior factor: forward substitution of unit loads on `dofs`, none of them kept. Visits only the fronts above
  /// them. Allocates a workspace.
  detail::ReducedUnits reduce_units(std::span<const Index> dofs) const;

  /// Entries `wanted` of K^-1 b, where b is zero except for `loads` on the dofs `loaded`. Visits only the fronts above
  /// the loaded and the wanted dofs; equals `solve_into` to the last bit. No allocation.
  void solve_path_into(std::span<const Index> loaded, std::span<const double> loads, std::span<const Index> wanted,
                       std::span<double> answer) noexcept;

 private:
  struct Factor;

  SparseCholesky(detail::CholeskyAnalysis analysis, const Matrix& lower, MatrixX* schur, const SetupLimits& limits);
  static std::shared_ptr<Factor> allocate(const detail::CholeskyAnalysis& analysis, bool interior);
  static MatrixX complement(const detail::CholeskyAnalysis& analysis, detail::ParallelFronts& fronts);
  void adopt(std::shared_ptr<Factor> made, detail::CholeskyAnalysis analysis);
  void hold_kept() noexcept;

  std::shared_ptr<const Factor> factor_;
  detail::FrontSweeps sweeps_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/linear/sparse_cholesky.ipp>
#endif
