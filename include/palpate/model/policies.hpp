// The solver policies a model is composed with, and what each stands for.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/assembly/matrix_free.hpp>
#include <palpate/concepts/assembler.hpp>
#include <palpate/condensation/condensed_system.hpp>
#include <palpate/condensation/schur.hpp>
#include <palpate/condensation/uncondensed.hpp>
#include <palpate/core/binary_io.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/linear/cholesky_analysis.hpp>
#include <palpate/linear/dense_cholesky.hpp>
#include <palpate/linear/dense_conjugate_gradient.hpp>
#include <palpate/linear/dense_inverse.hpp>
#include <palpate/linear/node_graph.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <Eigen/SparseCore>

#include <string_view>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Conjugate gradients; matrix-free unless WithAssembly says otherwise.
struct ConjugateGradient {};

/// The stored inverse with the selective product. Scalar is what a tick reads; it is always built in double.
template <std::floating_point Scalar>
struct BasicSelectiveInverse {};
using SelectiveInverse = BasicSelectiveInverse<double>;
using SelectiveInverseFloat = BasicSelectiveInverse<float>;

/// Keeps the touched dofs only and solves the condensed system with `Inner`: SelectiveInverse, SelectiveInverseFloat,
/// DenseCholesky or ConjugateGradient.
template <class Inner>
struct Condensed {
  static_assert(!std::same_as<Inner, SparseCholesky>,
                "the condensed stiffness is dense: choose Condensed<SelectiveInverse>, Condensed<DenseCholesky> or "
                "Condensed<ConjugateGradient>");
};

/// The same policy on another assembly: WithAssembly<ConjugateGradient, Assembled>.
template <class Policy, class Assembly>
struct WithAssembly {};

/// What a policy means: `Assembly`, `Scalar` of the contact compliance, whether it is `eager` (computed at set-up), and
/// how to make the prepared system from the stiffness and what is known of its dofs. Specialise it for a solver of your
/// own. With `cache_name` and `read` (see CacheablePolicy) the system can be kept in a cache file.
template <class Policy>
struct SolverTraits;

template <>
struct SolverTraits<SparseCholesky> {
  using Assembly = Assembled;
  using Scalar = double;
  static constexpr bool eager = false;
  static Uncondensed<SparseCholesky> make(const BlockMatrix& k, const EssentialConditions& conditions, DofLayout layout,
                                          const SetupLimits& limits) {
    std::vector<Index> kept = std::exchange(layout.kept, {});  // asked for, but nothing is condensed onto them
    const SparseMatrix lower = free_matrix(k, conditions);
    return {SparseCholesky(CholeskyAnalysis(lower, layout, limits), lower, limits), std::move(kept)};
  }

  static constexpr std::string_view cache_name = "SparseCholesky";
  static Uncondensed<SparseCholesky> read(BinaryReader& in, const BlockMatrix& k, const EssentialConditions& conditions,
                                          DofLayout layout, const SetupLimits& limits) {
    std::vector<Index> kept = std::exchange(layout.kept, {});
    const SparseMatrix lower = free_matrix(k, conditions);
    return {SparseCholesky::read(in, CholeskyAnalysis(lower, layout, limits), false, limits), std::move(kept)};
  }
};

template <class AssemblyPolicy>
struct SolverTraits<WithAssembly<ConjugateGradient, AssemblyPolicy>> {
  using Assembly = AssemblyPolicy;
  using Scalar = double;
  static constexpr bool eager = false;
  template <StiffnessOperator Stiffness>
  static auto make(const Stiffness& k, const EssentialConditions& conditions, DofLayout layout, const SetupLimits&) {
    using Solver = IterativeSolver<FreeStiffness<Stiffness>>;
    return Uncondensed<Solver>(Solver(FreeStiffness<Stiffness>(k, conditions), {}), std::move(layout.kept));
  }
};
template <>
struct SolverTraits<ConjugateGradient> : SolverTraits<WithAssembly<ConjugateGradient, MatrixFree>> {};

template <std::floating_point S>
struct SolverTraits<BasicSelectiveInverse<S>> {
  using Assembly = Assembled;
  using Scalar = S;
  static constexpr bool eager = true;
  static Uncondensed<DenseInverse<S>> make(const BlockMatrix& k, const EssentialConditions& conditions,
                                           DofLayout layout, const SetupLimits& limits) {
    const double n = static_cast<double>(conditions.free_count());
    limits.require_memory(3.0 * n * n * sizeof(double), "the inverse of the whole stiffness");
    return {DenseInverse<S>(MatrixX(free_matrix(k, conditions)), limits), std::move(layout.kept)};
  }

  static constexpr std::string_view cache_name = "SelectiveInverse";
  static Uncondensed<DenseInverse<S>> read(BinaryReader& in, const BlockMatrix&, const EssentialConditions& conditions,
                                           DofLayout layout, const SetupLimits& limits) {
    return {DenseInverse<S>::read(in, conditions.free_count(), limits), std::move(layout.kept)};
  }
};

/// Dense solver, scalar and eagerness of a condensed system.
template <class Inner>
struct CondensedTraits;
template <std::floating_point S>
struct CondensedTraits<BasicSelectiveInverse<S>> {
  using Solver = DenseInverse<S>;
  using Scalar = S;
  static constexpr bool eager = true;
  static constexpr std::string_view cache_name = "Condensed<SelectiveInverse>";
};
template <>
struct CondensedTraits<DenseCholesky> {
  using Solver = DenseCholesky;
  using Scalar = double;
  static constexpr bool eager = false;
  static constexpr std::string_view cache_name = "Condensed<DenseCholesky>";
};
template <>
struct CondensedTraits<ConjugateGradient> {
  using Solver = DenseConjugateGradient;
  using Scalar = double;
  static constexpr bool eager = false;
  static constexpr std::string_view cache_name = "Condensed<ConjugateGradient>";
};

template <class Inner>
struct SolverTraits<Condensed<Inner>> {
  static_assert(sizeof(Condensed<Inner>) > 0);  // what Condensed has to say of Inner is said first
  using Assembly = Assembled;
  using Scalar = typename CondensedTraits<Inner>::Scalar;
  static constexpr bool eager = CondensedTraits<Inner>::eager;
  using System = CondensedSystem<typename CondensedTraits<Inner>::Solver>;
  static System make(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                     const SetupLimits& limits) {
    return {condense(free_matrix(k, conditions), layout, limits), limits};
  }

  static constexpr std::string_view cache_name = CondensedTraits<Inner>::cache_name;
  static System read(BinaryReader& in, const BlockMatrix& k, const EssentialConditions& conditions,
                     const DofLayout& layout, const SetupLimits& limits) {
    return System::read(in, CholeskyAnalysis(free_matrix(k, conditions), layout, limits), limits);
  }
};

/// A policy that HapticFEModel can be composed with.
template <class P>
concept SolverPolicy = requires {
  typename SolverTraits<P>::Assembly;
  typename SolverTraits<P>::Scalar;
  { SolverTraits<P>::eager } -> std::convertible_to<bool>;
};

/// A policy whose prepared system can be stored: `cache_name` tells it from all others, the system has `write`, and
/// `read` makes it again from what was written, given the same stiffness, conditions and layout. `read` takes every
/// size from these and none from the file, and returns whatever it likes when the reader fails.
template <class P>
concept CacheablePolicy = SolverPolicy<P> &&
    requires(BinaryReader& in, BinaryWriter& out, const BlockMatrix& k, const EssentialConditions& conditions,
             const DofLayout& layout, const SetupLimits& limits) {
  requires std::same_as<typename SolverTraits<P>::Assembly, Assembled>;
  { SolverTraits<P>::cache_name } -> std::convertible_to<std::string_view>;
  SolverTraits<P>::read(in, k, conditions, layout, limits).write(out);
};

}}  // namespace palpate
