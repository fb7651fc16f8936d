// Definitions of policies.hpp.
#pragma once

#include <palpate/model/policies.hpp>

#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/condensation/detail/schur.hpp>
#include <palpate/condensation/static_systems.hpp>
#include <palpate/core/binary_io.hpp>
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
  const SparseMatrix lower = free_matrix(k, conditions);
  return {SparseCholesky(detail::CholeskyAnalysis(lower, layout, limits), lower, limits), std::move(kept)};
}

PALPATE_INLINE Uncondensed SolverTraits<SparseCholesky>::read(BinaryReader& in, const BlockMatrix& k,
                                                              const EssentialConditions& conditions,
                                                              const DofLayout& given, const SetupLimits& limits) {
  DofLayout layout = given;
  std::vector<Index> kept = std::exchange(layout.kept, {});
  const SparseMatrix lower = free_matrix(k, conditions);
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

template <std::floating_point S>
Uncondensed make_inverse(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                         const SetupLimits& limits) {
  const Index n = conditions.free_count();
  limits.require_memory(3.0 * static_cast<double>(n) * static_cast<double>(n) * sizeof(double),
                        "the inverse of the whole stiffness");
  MatrixX lower(n, n);
  std::fill_n(lower.data(), lower.size(), 0.0);
  for_each_free_entry(k, conditions,
                      [&](Index row, Index column, double value) { lower.coeffRef(row, column) = value; });
  return {DenseInverse<S>(std::move(lower), limits), layout.kept};
}

template <std::floating_point S>
Uncondensed read_inverse(BinaryReader& in, const EssentialConditions& conditions, const DofLayout& layout,
                         const SetupLimits& limits) {
  return {DenseInverse<S>::read(in, conditions.free_count(), limits), layout.kept};
}

template <class Dense>
CondensedSystem make_condensed(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                               const SetupLimits& limits) {
  return CondensedSystem::with<Dense>(condense(free_matrix(k, conditions), layout, limits), limits);
}

template <class Dense>
CondensedSystem read_condensed(BinaryReader& in, const BlockMatrix& k, const EssentialConditions& conditions,
                               const DofLayout& layout, const SetupLimits& limits) {
  return CondensedSystem::read<Dense>(in, CholeskyAnalysis(free_matrix(k, conditions), layout, limits), limits);
}

#if !PALPATE_HEADER_ONLY
#define PALPATE_DENSE_SOLVER(...)                                                                                     \
  template CondensedSystem make_condensed<__VA_ARGS__>(const BlockMatrix&, const EssentialConditions&,                \
                                                       const DofLayout&, const SetupLimits&);                         \
  template CondensedSystem read_condensed<__VA_ARGS__>(BinaryReader&, const BlockMatrix&, const EssentialConditions&, \
                                                       const DofLayout&, const SetupLimits&);
#define PALPATE_WHOLE_INVERSE(S)                                                                         \
  template Uncondensed make_inverse<S>(const BlockMatrix&, const EssentialConditions&, const DofLayout&, \
                                       const SetupLimits&);                                              \
  template Uncondensed read_inverse<S>(BinaryReader&, const EssentialConditions&, const DofLayout&, const SetupLimits&);
PALPATE_DENSE_SOLVER(DenseInverse<double>)
PALPATE_DENSE_SOLVER(DenseInverse<float>)
PALPATE_DENSE_SOLVER(DenseCholesky)
PALPATE_DENSE_SOLVER(DenseConjugateGradient)
PALPATE_WHOLE_INVERSE(double)
PALPATE_WHOLE_INVERSE(float)
#undef PALPATE_DENSE_SOLVER
#undef PALPATE_WHOLE_INVERSE
#endif

}  // namespace detail

}}  // namespace palpate
