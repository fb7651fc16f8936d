// CHOLMOD's supernodal factorisation as a baseline; empty when CHOLMOD was not found.
#include "cholmod.hpp"

#include "../common/timing.hpp"

#if defined(PALPATE_BENCH_CHOLMOD)
#include <cholmod.h>

#include <stdexcept>

#if defined(__ELF__)  // functions of the libraries that CHOLMOD links; null when they do not exist
extern "C" {
void openblas_set_num_threads(int) __attribute__((weak));
char* openblas_get_corename() __attribute__((weak));
void omp_set_max_active_levels(int) __attribute__((weak));
}
#endif

namespace bench {

struct Cholmod::Implementation {
  cholmod_common common{};
  cholmod_sparse matrix{};
  cholmod_factor* factor = nullptr;
  double analysis_seconds = 0.0;
};

namespace {

/// Limits BLAS and OpenMP.
void use_threads(int count) noexcept {
#if defined(__ELF__)
  // CHOLMOD requests four threads regardless of the configured number; only zero active levels prevent that.
  if (omp_set_max_active_levels != nullptr) omp_set_max_active_levels(count > 1 ? 1 : 0);
  if (openblas_set_num_threads != nullptr) openblas_set_num_threads(count);
#else
  (void)count;
#endif
}

}  // namespace

bool Cholmod::available() noexcept {
  return true;
}
std::string Cholmod::blas() {
#if defined(__ELF__)
  if (openblas_get_corename != nullptr) return std::string("OpenBLAS, kernels for ") + openblas_get_corename();
#endif
  return "the system's BLAS";
}
void Cholmod::set_threads(int count) noexcept {
  use_threads(count);
}

Cholmod::Cholmod(const palpate::SparseMatrix& lower) : implementation_(std::make_unique<Implementation>()) {
  static_assert(sizeof(SuiteSparse_long) == sizeof(palpate::Index));
  use_threads(1);
  cholmod_common& c = implementation_->common;
  cholmod_l_start(&c);
  c.supernodal = CHOLMOD_SUPERNODAL;
  c.nmethods = 1;
  c.method[0].ordering = CHOLMOD_METIS;
  c.postorder = 1;
  c.final_ll = 1;
  cholmod_sparse& a = implementation_->matrix;
  a.nrow = a.ncol = static_cast<std::size_t>(lower.rows());
  a.nzmax = static_cast<std::size_t>(lower.nonZeros());
  a.p = const_cast<palpate::Index*>(lower.outerIndexPtr());
  a.i = const_cast<palpate::Index*>(lower.innerIndexPtr());
  a.x = const_cast<double*>(lower.valuePtr());
  a.stype = -1;
  a.itype = CHOLMOD_LONG;
  a.xtype = CHOLMOD_REAL;
  a.dtype = CHOLMOD_DOUBLE;
  a.sorted = a.packed = 1;
  implementation_->analysis_seconds = seconds_of([&] { implementation_->factor = cholmod_l_analyze(&a, &c); });
}

Cholmod::~Cholmod() {
  cholmod_l_free_factor(&implementation_->factor, &implementation_->common);
  cholmod_l_finish(&implementation_->common);
}

double Cholmod::analysis_seconds() const noexcept {
  return implementation_->analysis_seconds;
}
double Cholmod::peak_bytes() const noexcept {
  return static_cast<double>(implementation_->common.memory_usage);
}
double Cholmod::flops() const noexcept {
  return implementation_->common.fl;
}

void Cholmod::factorise() {
  cholmod_l_factorize(&implementation_->matrix, implementation_->factor, &implementation_->common);
  if (implementation_->common.status != CHOLMOD_OK) throw std::runtime_error("CHOLMOD did not factorise");
}

palpate::VectorX Cholmod::solve(const palpate::VectorX& b) const {
  cholmod_common& c = implementation_->common;
  cholmod_dense* right = cholmod_l_zeros(static_cast<std::size_t>(b.size()), 1, CHOLMOD_REAL, &c);
  std::copy_n(b.data(), b.size(), static_cast<double*>(right->x));
  cholmod_dense* answer = cholmod_l_solve(CHOLMOD_A, implementation_->factor, right, &c);
  palpate::VectorX x = Eigen::Map<palpate::VectorX>(static_cast<double*>(answer->x), b.size());
  cholmod_l_free_dense(&right, &c);
  cholmod_l_free_dense(&answer, &c);
  return x;
}

}  // namespace bench

#else

namespace bench {

struct Cholmod::Implementation {};
bool Cholmod::available() noexcept {
  return false;
}
std::string Cholmod::blas() {
  return "";
}
void Cholmod::set_threads(int) noexcept {}
Cholmod::Cholmod(const palpate::SparseMatrix&) {}
Cholmod::~Cholmod() = default;
double Cholmod::analysis_seconds() const noexcept {
  return unknown;
}
double Cholmod::peak_bytes() const noexcept {
  return unknown;
}
double Cholmod::flops() const noexcept {
  return unknown;
}
void Cholmod::factorise() {}
palpate::VectorX Cholmod::solve(const palpate::VectorX& b) const {
  return b;
}

}  // namespace bench

#endif
