// Type-erased operators and solvers with value semantics.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/executor.hpp>

#include <memory>
#include <span>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryWriter;

/// A solver that can compute a few entries of the solution for a few loads faster than the whole solution.
template <class S>
concept PathSolver = requires(S& s, std::span<const Index> dofs, std::span<const double> loads,
                              std::span<double> answer) {
  { s.solve_path_into(dofs, loads, dofs, answer) }
  noexcept;
};

/// A solver that can use the threads of a set-up, with the same result.
template <class S>
concept ThreadedSolver = requires(S& s, const VectorX& b, VectorX& x, const SetupThreads& threads) {
  { s.solve_into(b, x, threads) }
  noexcept;
};

/// Solves on the threads of a set-up if the solver can.
template <class S>
SolveReport solve_on(const SetupThreads& threads, S& solver, const VectorX& b, VectorX& x) noexcept {
  if constexpr (ThreadedSolver<S>)
    return solver.solve_into(b, x, threads);
  else
    return solver.solve_into(b, x);
}

/// Owns any copyable SpdOperator; copying copies the operator. One indirect call per product.
class AnyOperator {
 public:
  AnyOperator() = default;
  template <SpdOperator Op>
  requires(!std::same_as<Op, AnyOperator>) AnyOperator(Op op) : op_(std::make_unique<Holder<Op>>(std::move(op))) {}
  AnyOperator(const AnyOperator& other) : op_(other.op_ ? other.op_->copy() : nullptr) {}
  AnyOperator(AnyOperator&&) noexcept = default;
  AnyOperator& operator=(AnyOperator other) noexcept {
    op_ = std::move(other.op_);
    return *this;
  }

  Index size() const noexcept { return op_ ? op_->size() : 0; }
  /// What the operator reports; 0 when it reports nothing.
  std::size_t bytes() const noexcept { return op_ ? op_->bytes() : 0; }
  void apply(const VectorX& x, VectorX& y) const noexcept { op_->apply(x, y); }
  void precondition(const VectorX& x, VectorX& y) const noexcept { op_->precondition(x, y); }

 private:
  struct Base {
    virtual ~Base() = default;
    virtual std::unique_ptr<Base> copy() const = 0;
    virtual Index size() const noexcept = 0;
    virtual std::size_t bytes() const noexcept = 0;
    virtual void apply(const VectorX& x, VectorX& y) const noexcept = 0;
    virtual void precondition(const VectorX& x, VectorX& y) const noexcept = 0;
  };
  template <class Op>
  struct Holder final : Base {
    explicit Holder(Op given) : op(std::move(given)) {}
    std::unique_ptr<Base> copy() const override { return std::make_unique<Holder>(op); }
    Index size() const noexcept override { return static_cast<Index>(op.size()); }
    std::size_t bytes() const noexcept override {
      if constexpr (requires { op.bytes(); }) return static_cast<std::size_t>(op.bytes());
      return 0;
    }
    void apply(const VectorX& x, VectorX& y) const noexcept override { op.apply(x, y); }
    void precondition(const VectorX& x, VectorX& y) const noexcept override { op.precondition(x, y); }
    Op op;
  };

  std::unique_ptr<Base> op_;
};

/// Owns any copyable LinearSolver that reports its `bytes`; copying copies the solver. One indirect call per solve.
/// Satisfies LinearSolver.
class AnySolver {
 public:
  AnySolver() = default;
  template <LinearSolver S>
  requires(!std::same_as<S, AnySolver>) AnySolver(S solver) : solver_(std::make_unique<Holder<S>>(std::move(solver))) {}
  AnySolver(const AnySolver& other) : solver_(other.solver_ ? other.solver_->copy() : nullptr) {}
  AnySolver(AnySolver&&) noexcept = default;
  AnySolver& operator=(AnySolver other) noexcept {
    solver_ = std::move(other.solver_);
    return *this;
  }

  Index size() const noexcept { return solver_ ? solver_->size() : 0; }
  std::size_t bytes() const noexcept { return solver_ ? solver_->bytes() : 0; }
  SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads = 1) noexcept {
    return solver_->solve_into(b, x, threads);
  }
  /// Entries `wanted` of the solution for `loads` on a few dofs. Returns false and does nothing when the solver is no
  /// PathSolver.
  bool solve_path_into(std::span<const Index> loaded, std::span<const double> loads, std::span<const Index> wanted,
                       std::span<double> answer) noexcept {
    return solver_->solve_path_into(loaded, loads, wanted, answer);
  }
  /// Returns false and writes nothing when the solver cannot be stored.
  bool write(BinaryWriter& out) const { return solver_ && solver_->write(out); }

 private:
  struct Base {
    virtual ~Base() = default;
    virtual std::unique_ptr<Base> copy() const = 0;
    virtual Index size() const noexcept = 0;
    virtual std::size_t bytes() const noexcept = 0;
    virtual SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads) noexcept = 0;
    virtual bool solve_path_into(std::span<const Index> loaded, std::span<const double> loads,
                                 std::span<const Index> wanted, std::span<double> answer) noexcept = 0;
    virtual bool write(BinaryWriter& out) const = 0;
  };
  template <class S>
  struct Holder final : Base {
    explicit Holder(S given) : solver(std::move(given)) {}
    std::unique_ptr<Base> copy() const override { return std::make_unique<Holder>(solver); }
    Index size() const noexcept override { return static_cast<Index>(solver.size()); }
    std::size_t bytes() const noexcept override {
      if constexpr (requires { solver.bytes(); }) return static_cast<std::size_t>(solver.bytes());
      return sizeof solver;
    }
    SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads) noexcept override {
      return solve_on(threads, solver, b, x);
    }
    bool solve_path_into(std::span<const Index> loaded, std::span<const double> loads, std::span<const Index> wanted,
                         std::span<double> answer) noexcept override {
      if constexpr (PathSolver<S>) solver.solve_path_into(loaded, loads, wanted, answer);
      return PathSolver<S>;
    }
    bool write(BinaryWriter& out) const override {
      constexpr bool storable = requires {
        solver.write(out);
      };
      if constexpr (storable) solver.write(out);
      return storable;
    }
    S solver;
  };

  std::unique_ptr<Base> solver_;
};

static_assert(LinearSolver<AnySolver>);

}}  // namespace palpate
