// CHOLMOD's supernodal factorisation as a baseline, where it is installed. The library itself does not use it.
#pragma once

#include <palpate/assembly/free_stiffness.hpp>

#include <memory>
#include <string>

namespace bench {

/// METIS ordering, LL^T. One thread by default.
class Cholmod {
 public:
  static bool available() noexcept;
  /// The BLAS of its dense operations. An OpenBLAS older than the processor may use the kernels of an old one: the
  /// environment variable OPENBLAS_CORETYPE chooses others.
  static std::string blas();
  /// For BLAS and OpenMP, from now on.
  static void set_threads(int count) noexcept;

  /// Analyses the symmetric matrix with this lower triangle. `lower` must outlive this object.
  explicit Cholmod(const palpate::SparseMatrix& lower);
  ~Cholmod();

  double analysis_seconds() const noexcept;
  double peak_bytes() const noexcept;  ///< the most that it had allocated so far
  double flops() const noexcept;       ///< multiplications and additions of its factorisation
  void factorise();
  palpate::VectorX solve(const palpate::VectorX& b) const;

 private:
  struct Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace bench
