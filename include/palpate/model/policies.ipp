// Definitions of policies.hpp.
#pragma once

#include <palpate/model/policies.hpp>

#include <palpate/assembly/detail/free_stiffness.hpp>
#include <palpate/condensation/detail/schur.hpp>
#include <palpate/condensation/static_systems.hpp>
#include <palpate/core/detail/binary_io.hpp>
#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Uncondensed SolverTraits<SparseCholesky>::make(const BlockMatrix& k,
                                                              const EssentialConditions& conditions,
                                                              const DofLayout& given, const SetupLimits& limits) {
  DofLayout layout = given;
  std::vector<Index> kept = std::exchange(layout.kept, {});  // requested, but nothing is condensed onto them
  const detail::SparseMatrix lower = detail::free_matrix(k, conditions);
  return {SparseCholesky(detail::CholeskyAnalysis(lower, layout, limits), lower, limits), std::move(kept)};
}

PALPATE_INLINE Uncondensed SolverTraits<SparseCholesky>::read(BinaryReader& in, const BlockMatrix& k,
                                                              const EssentialConditions& conditions,
                                                              const DofLayout& given, const SetupLimits& limits) {
  DofLayout layout = given;
  std::vector<Index> kept = std::exchange(layout.kept, {});
  const detail::SparseMatrix lower = detail::free_matrix(k, conditions);
  return {SparseCholesky::read(in, detail::CholeskyAnalysis(lower, layout, limits), false, limits), std::move(kept)};
}

PALPATE_INLINE Uncondensed SolverTraits<ConjugateGradient>::make(const BlockMatrix& k,
                                                                 const EssentialConditions& conditions,
                                                                 const DofLayout& layout, const SetupLimits& limits) {
  return {detail::IterativeSolver(detail::FreeStiffness(k, conditions, limits), {}), layout.kept};
}

namespace detail {

PALPATE_INLINE Uncondensed make_iterative(const StiffnessView& k, const EssentialConditions& conditions,
                                          const DofLayout& layout) {
  return {IterativeSolver(FreeStiffness(k, conditions), {}), layout.kept};
}

PALPATE_INLINE Uncondensed make_inverse(DenseKind kind, const BlockMatrix& k, const EssentialConditions& conditions,
                                        const DofLayout& layout, const SetupLimits& limits) {
  const Index n = conditions.free_count();
  limits.require_memory(3.0 * static_cast<double>(n) * static_cast<double>(n) * sizeof(double),
                        "the inverse of the whole stiffness");
  MatrixX lower(n, n);
  std::fill_n(lower.data(), lower.size(), 0.0);
  for_each_free_entry(k, conditions,
                      [&](Index row, Index column, double value) { lower.coeffRef(row, column) = value; });
  if (kind == DenseKind::inverse_float) return {DenseInverse<float>(std::move(lower), limits), layout.kept};
  return {DenseInverse<double>(std::move(lower), limits), layout.kept};
}

PALPATE_INLINE Uncondensed read_inverse(DenseKind kind, BinaryReader& in, const EssentialConditions& conditions,
                                        const DofLayout& layout, const SetupLimits& limits) {
  if (kind == DenseKind::inverse_float)
    return {DenseInverse<float>::read(in, conditions.free_count(), limits), layout.kept};
  return {DenseInverse<double>::read(in, conditions.free_count(), limits), layout.kept};
}

PALPATE_INLINE CondensedSystem make_condensed(DenseKind kind, const BlockMatrix& k,
                                              const EssentialConditions& conditions, const DofLayout& layout,
                                              const SetupLimits& limits) {
  SchurComplement schur = condense(free_matrix(k, conditions), layout, limits);
  switch (kind) {
    case DenseKind::inverse_float:
      return CondensedSystem::with<DenseInverse<float>>(std::move(schur), limits);
    case DenseKind::cholesky:
      return CondensedSystem::with<DenseCholesky>(std::move(schur), limits);
    case DenseKind::conjugate_gradient:
      return CondensedSystem::with<DenseConjugateGradient>(std::move(schur), limits);
    case DenseKind::inverse:
      break;
  }
  return CondensedSystem::with<DenseInverse<double>>(std::move(schur), limits);
}

PALPATE_INLINE CondensedSystem read_condensed(DenseKind kind, BinaryReader& in, const BlockMatrix& k,
                                              const EssentialConditions& conditions, const DofLayout& layout,
                                              const SetupLimits& limits) {
  CholeskyAnalysis analysis(free_matrix(k, conditions), layout, limits);
  switch (kind) {
    case DenseKind::inverse_float:
      return CondensedSystem::read<DenseInverse<float>>(in, std::move(analysis), limits);
    case DenseKind::cholesky:
      return CondensedSystem::read<DenseCholesky>(in, std::move(analysis), limits);
    case DenseKind::conjugate_gradient:
      return CondensedSystem::read<DenseConjugateGradient>(in, std::move(analysis), limits);
    case DenseKind::inverse:
      break;
  }
  return CondensedSystem::read<DenseInverse<double>>(in, std::move(analysis), limits);
}

}  // namespace detail

}}  // namespace palpate
