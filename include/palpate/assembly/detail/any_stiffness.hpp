// Type-erased stiffness of a mesh, stored or matrix-free.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/concepts/linear_solver.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Refers to any StiffnessOperator, which must outlive it. One indirect call per product.
class StiffnessView {
 public:
  template <StiffnessOperator K>
  StiffnessView(const K& k) noexcept  // NOLINT(google-explicit-constructor)
      : k_(&k),
        size_(static_cast<Index>(k.size())),
        apply_([](const void* p, const VectorX& x, VectorX& y) noexcept { static_cast<const K*>(p)->apply(x, y); }),
        diagonal_blocks_([](const void* p) { return static_cast<const K*>(p)->diagonal_blocks(); }) {}
  StiffnessView(const StiffnessView&) = default;

  /// Number of dofs, including constrained ones.
  Index size() const noexcept { return size_; }
  /// y = K x [N]. No allocation.
  void apply(const VectorX& x, VectorX& y) const noexcept { apply_(k_, x, y); }
  /// The 3 x 3 diagonal block of every node.
  std::vector<Matrix3> diagonal_blocks() const { return diagonal_blocks_(k_); }

 private:
  const void* k_;
  Index size_;
  void (*apply_)(const void*, const VectorX&, VectorX&) noexcept;
  std::vector<Matrix3> (*diagonal_blocks_)(const void*);
};

namespace detail {

/// Owns any StiffnessOperator. Movable, not copyable; the address of the owned operator is stable.
class AnyStiffness {
 public:
  AnyStiffness() = default;
  template <StiffnessOperator K>
  explicit AnyStiffness(K k) : owned_(std::make_unique<Holder<K>>(std::move(k))) {}

  Index size() const noexcept { return owned_->view.size(); }
  void apply(const VectorX& x, VectorX& y) const noexcept { owned_->view.apply(x, y); }
  std::vector<Matrix3> diagonal_blocks() const { return owned_->view.diagonal_blocks(); }
  std::size_t bytes() const noexcept { return owned_->bytes; }
  StiffnessView view() const noexcept { return owned_->view; }
  /// The stored matrix; null without one.
  const BlockMatrix* matrix() const noexcept { return owned_->matrix; }

 private:
  struct Base {
    Base(StiffnessView seen, std::size_t size) : view(seen), bytes(size) {}
    virtual ~Base() = default;
    StiffnessView view;
    std::size_t bytes;
    const BlockMatrix* matrix = nullptr;
  };
  template <class K>
  struct Owned {
    K k;
  };
  template <class K>
  struct Holder final : Owned<K>, Base {
    explicit Holder(K given) : Owned<K>{std::move(given)}, Base(this->k, this->k.bytes()) {
      if constexpr (std::same_as<K, BlockMatrix>) this->matrix = &this->k;
    }
  };

  std::unique_ptr<Base> owned_;
};

}  // namespace detail

}}  // namespace palpate
