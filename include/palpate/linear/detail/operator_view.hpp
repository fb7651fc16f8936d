// Type-erased references to operators and solvers.
#pragma once

#include <palpate/concepts/linear_solver.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Refers to any SpdOperator, which must outlive it; argument of the iterative solvers. One indirect call per product.
class OperatorView {
 public:
  template <SpdOperator Op>
  OperatorView(const Op& op) noexcept
      : op_(&op),
        size_(static_cast<Index>(op.size())),
        apply_([](const void* p, const VectorX& x, VectorX& y) noexcept { static_cast<const Op*>(p)->apply(x, y); }),
        precondition_([](const void* p, const VectorX& x, VectorX& y) noexcept {
          static_cast<const Op*>(p)->precondition(x, y);
        }) {}
  OperatorView(const OperatorView&) = default;

  Index size() const noexcept { return size_; }
  void apply(const VectorX& x, VectorX& y) const noexcept { apply_(op_, x, y); }
  void precondition(const VectorX& x, VectorX& y) const noexcept { precondition_(op_, x, y); }

 private:
  using Function = void (*)(const void*, const VectorX&, VectorX&) noexcept;
  const void* op_;
  Index size_;
  Function apply_, precondition_;
};

/// Refers to any LinearSolver, which must outlive it.
class SolverView {
 public:
  template <LinearSolver S>
  SolverView(S& solver) noexcept
      : solver_(&solver),
        size_(static_cast<Index>(solver.size())),
        solve_([](void* p, const VectorX& b, VectorX& x) noexcept { return static_cast<S*>(p)->solve_into(b, x); }) {}
  SolverView(const SolverView&) = default;
  SolverView(SolverView&) = default;

  Index size() const noexcept { return size_; }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept { return solve_(solver_, b, x); }

 private:
  void* solver_;
  Index size_;
  SolveReport (*solve_)(void*, const VectorX&, VectorX&) noexcept;
};

}}  // namespace palpate
