// A prepared static system of any type with value semantics.
#pragma once

#include <palpate/concepts/condensation.hpp>
#include <palpate/linear/detail/any_solver.hpp>

#include <concepts>
#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

class BinaryWriter;

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

}}  // namespace palpate
