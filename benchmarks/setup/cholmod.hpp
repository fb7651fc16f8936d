// CHOLMOD's supernodal factorisation as a baseline, where it is installed. The library itself never uses it.
#pragma once

#include <palpate/assembly/detail/free_stiffness.hpp>

#include <memory>

namespace bench {

/// One thread, METIS ordering, LL^T.
class Cholmod {
 public:
  static bool available() noexcept;
  /// What its dense operations come from.
  static const char* blas() noexcept;

  /// Analyses the matrix whose lower half is given. It must outlive this.
  explicit Cholmod(const palpate::SparseMatrix& lower);
  ~Cholmod();

  double analysis_seconds() const noexcept;
  double flops() const noexcept;  ///< multiplications and additions of its factorisation
  void factorise();
  palpate::VectorX solve(const palpate::VectorX& b) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace bench
