// The solver policies of a model, and their traits.
#pragma once

#include <palpate/core/types.hpp>

#include <concepts>
#include <string_view>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

struct Assembled;
struct MatrixFree;
struct DofLayout;
struct EssentialConditions;
struct SetupLimits;
class BinaryReader;
class BinaryWriter;
class BlockMatrix;
class CondensedSystem;
class DenseCholesky;
template <std::floating_point Scalar>
class DenseInverse;
class SparseCholesky;
class StiffnessView;
class Uncondensed;

/// Conjugate gradients on the stored stiffness, preconditioned by an incomplete factorisation.
struct ConjugateGradient {};

/// The stored inverse with the selective product. Scalar is the type that a tick reads; the inverse is always computed
/// in double.
template <std::floating_point Scalar>
struct BasicSelectiveInverse {};
using SelectiveInverse = BasicSelectiveInverse<double>;
using SelectiveInverseFloat = BasicSelectiveInverse<float>;

/// Condenses the system onto the touched dofs and solves it with `Inner`: SelectiveInverse, SelectiveInverseFloat,
/// DenseCholesky or ConjugateGradient.
template <class Inner>
struct Condensed {
  static_assert(!std::same_as<Inner, SparseCholesky>,
                "the condensed stiffness is dense: choose Condensed<SelectiveInverse>, Condensed<DenseCholesky> or "
                "Condensed<ConjugateGradient>");
};

/// The same policy with another assembly. WithAssembly<ConjugateGradient, MatrixFree> stores no stiffness; its
/// preconditioner is block Jacobi, with several times as many iterations.
template <class Policy, class Assembly>
struct WithAssembly {};

namespace detail {

class DenseConjugateGradient;

// Defined in policies.ipp, and compiled for the solvers that are named here.
Uncondensed make_iterative(const StiffnessView& k, const EssentialConditions& conditions, const DofLayout& layout);
template <std::floating_point S>
Uncondensed make_inverse(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                         const SetupLimits& limits);
template <std::floating_point S>
Uncondensed read_inverse(BinaryReader& in, const EssentialConditions& conditions, const DofLayout& layout,
                         const SetupLimits& limits);
template <class Dense>
CondensedSystem make_condensed(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                               const SetupLimits& limits);
template <class Dense>
CondensedSystem read_condensed(BinaryReader& in, const BlockMatrix& k, const EssentialConditions& conditions,
                               const DofLayout& layout, const SetupLimits& limits);

}  // namespace detail

/// Traits of a policy: `Assembly`; `Scalar` of the contact compliance; `eager`, true when the compliance is computed at
/// set-up; and `make`, which builds the prepared system from the stiffness (a BlockMatrix when Assembly is Assembled,
/// else a StiffnessView) and the dof layout. Specialise it for a user-defined solver. With `cache_name` and `read` (see
/// CacheablePolicy) the system can be stored in a cache file.
template <class Policy>
struct SolverTraits;

template <>
struct SolverTraits<SparseCholesky> {
  using Assembly = Assembled;
  using Scalar = double;
  static constexpr bool eager = false;
  static constexpr std::string_view cache_name = "SparseCholesky";
  static Uncondensed make(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                          const SetupLimits& limits);
  static Uncondensed read(BinaryReader& in, const BlockMatrix& k, const EssentialConditions& conditions,
                          const DofLayout& layout, const SetupLimits& limits);
};

template <class AssemblyPolicy>
struct SolverTraits<WithAssembly<ConjugateGradient, AssemblyPolicy>> {
  using Assembly = AssemblyPolicy;
  using Scalar = double;
  static constexpr bool eager = false;
  static Uncondensed make(const StiffnessView& k, const EssentialConditions& conditions, const DofLayout& layout,
                          const SetupLimits& limits);
};
template <>
struct SolverTraits<ConjugateGradient> {
  using Assembly = Assembled;
  using Scalar = double;
  static constexpr bool eager = false;
  static Uncondensed make(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                          const SetupLimits& limits);
};
template <>
struct SolverTraits<WithAssembly<ConjugateGradient, Assembled>> : SolverTraits<ConjugateGradient> {};

template <std::floating_point S>
struct SolverTraits<BasicSelectiveInverse<S>> {
  using Assembly = Assembled;
  using Scalar = S;
  static constexpr bool eager = true;
  static constexpr std::string_view cache_name = "SelectiveInverse";
  static Uncondensed make(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                          const SetupLimits& limits);
  static Uncondensed read(BinaryReader& in, const BlockMatrix&, const EssentialConditions& conditions,
                          const DofLayout& layout, const SetupLimits& limits);
};

namespace detail {

/// Dense solver, scalar and eagerness of a condensed system.
template <class Inner>
struct CondensedTraits;
template <std::floating_point S>
struct CondensedTraits<BasicSelectiveInverse<S>> {
  using Scalar = S;
  using Dense = DenseInverse<S>;
  static constexpr bool eager = true;
  static constexpr std::string_view cache_name = "Condensed<SelectiveInverse>";
};
template <>
struct CondensedTraits<DenseCholesky> {
  using Scalar = double;
  using Dense = DenseCholesky;
  static constexpr bool eager = false;
  static constexpr std::string_view cache_name = "Condensed<DenseCholesky>";
};
template <>
struct CondensedTraits<ConjugateGradient> {
  using Scalar = double;
  using Dense = DenseConjugateGradient;
  static constexpr bool eager = false;
  static constexpr std::string_view cache_name = "Condensed<ConjugateGradient>";
};

}  // namespace detail

template <class Inner>
struct SolverTraits<Condensed<Inner>> {
  static_assert(sizeof(Condensed<Inner>) > 0);  // triggers the static_assert of Condensed first
  using Assembly = Assembled;
  using Scalar = typename detail::CondensedTraits<Inner>::Scalar;
  static constexpr bool eager = detail::CondensedTraits<Inner>::eager;
  static constexpr std::string_view cache_name = detail::CondensedTraits<Inner>::cache_name;
  static CondensedSystem make(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                              const SetupLimits& limits);
  static CondensedSystem read(BinaryReader& in, const BlockMatrix& k, const EssentialConditions& conditions,
                              const DofLayout& layout, const SetupLimits& limits);
};

/// A policy that HapticFEModel can be composed with.
template <class P>
concept SolverPolicy = requires {
  typename SolverTraits<P>::Assembly;
  typename SolverTraits<P>::Scalar;
  { SolverTraits<P>::eager } -> std::convertible_to<bool>;
};

/// A policy whose prepared system can be stored: `cache_name` is unique, the system has `write`, and `read` restores it
/// from the written data, given the same stiffness, conditions and layout. `read` takes every size from these arguments
/// and none from the file; its result is unspecified when the reader fails.
template <class P>
concept CacheablePolicy = SolverPolicy<P> &&
    requires(BinaryReader& in, BinaryWriter& out, const BlockMatrix& k, const EssentialConditions& conditions,
             const DofLayout& layout, const SetupLimits& limits) {
  requires std::same_as<typename SolverTraits<P>::Assembly, Assembled>;
  { SolverTraits<P>::cache_name } -> std::convertible_to<std::string_view>;
  SolverTraits<P>::read(in, k, conditions, layout, limits).write(out);
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/policies.ipp>
#endif
