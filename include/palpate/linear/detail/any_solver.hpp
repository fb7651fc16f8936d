// Type-erased operators, solvers and prepared static systems: references and values.
#pragma once

#include <palpate/concepts/linear_solver.hpp>
#include <palpate/core/executor.hpp>

#include <concepts>
#include <memory>
#include <span>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryWriter;

namespace detail {

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

/// Owns any copyable StaticSystem. Each copy has its own workspaces; copies share factors. One indirect call per solve.
class AnyStaticSystem {
 public:
  AnyStaticSystem() = default;
  template <StaticSystem S>
  requires(!std::same_as<S, AnyStaticSystem>) explicit AnyStaticSystem(S system)
      : system_(std::make_unique<Holder<S>>(std::move(system))) {}
  AnyStaticSystem(const AnyStaticSystem& other) : system_(other.system_ ? other.system_->copy() : nullptr) {}
  AnyStaticSystem(AnyStaticSystem&&) noexcept = default;
  AnyStaticSystem& operator=(AnyStaticSystem other) noexcept {
    system_ = std::move(other.system_);
    return *this;
  }

  Index size() const noexcept { return system_ ? system_->size() : 0; }
  Index kept() const noexcept { return system_ ? system_->kept() : 0; }
  std::size_t bytes() const noexcept { return system_ ? system_->bytes() : 0; }
  /// Upper bound of the bytes that `compliance_column` reads per sweep or iteration; the whole system unless it has a
  /// function `column_bytes()`.
  std::size_t column_bytes() const noexcept { return system_ ? system_->column_bytes() : 0; }
  SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads = 1) noexcept {
    return system_->solve_into(b, x, threads);
  }
  SolveReport compliance_column(Index j, VectorX& column) noexcept { return system_->compliance_column(j, column); }
  /// Writes a system that can be stored; writes nothing for others.
  void write(BinaryWriter& out) const { system_->write(out); }

 private:
  struct Base {
    virtual ~Base() = default;
    virtual std::unique_ptr<Base> copy() const = 0;
    virtual Index size() const noexcept = 0;
    virtual Index kept() const noexcept = 0;
    virtual std::size_t bytes() const noexcept = 0;
    virtual std::size_t column_bytes() const noexcept = 0;
    virtual SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads) noexcept = 0;
    virtual SolveReport compliance_column(Index j, VectorX& column) noexcept = 0;
    virtual void write(BinaryWriter& out) const = 0;
  };
  template <class S>
  struct Holder final : Base {
    explicit Holder(S given) : system(std::move(given)) {}
    std::unique_ptr<Base> copy() const override { return std::make_unique<Holder>(system); }
    Index size() const noexcept override { return static_cast<Index>(system.size()); }
    Index kept() const noexcept override { return static_cast<Index>(system.kept()); }
    std::size_t bytes() const noexcept override { return static_cast<std::size_t>(system.bytes()); }
    std::size_t column_bytes() const noexcept override {
      if constexpr (requires { system.column_bytes(); })
        return static_cast<std::size_t>(system.column_bytes());
      else
        return bytes();
    }
    SolveReport solve_into(const VectorX& b, VectorX& x, const SetupThreads& threads) noexcept override {
      return solve_on(threads, system, b, x);
    }
    SolveReport compliance_column(Index j, VectorX& column) noexcept override {
      return system.compliance_column(j, column);
    }
    void write([[maybe_unused]] BinaryWriter& out) const override {
      if constexpr (requires { system.write(out); }) system.write(out);
    }
    S system;
  };

  std::unique_ptr<Base> system_;
};

static_assert(StaticSystem<AnyStaticSystem>);

}  // namespace detail

}}  // namespace palpate
