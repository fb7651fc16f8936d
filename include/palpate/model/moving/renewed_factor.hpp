// A factor that a background thread recomputes while steps continue with the previous one.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/essential_conditions.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/model/moving/detail/renewal_thread.hpp>
#include <palpate/model/moving/detail/step_preconditioners.hpp>
#include <palpate/model/moving/detail/tangent_solver.hpp>
#include <palpate/model/moving/detail/corotated_solve.hpp>

#include <array>
#include <memory>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Preconditioner of CorotatedMotion: the factor of A at a recent state s, rotated from there with the nodes, (R R_s^T)
/// A_s^-1 (R R_s^T)^T (asynchronous preconditioning, Courtecuisse et al. 2010). When a renewal is due and the thread is
/// idle, an update passes the state to the thread; the next update takes a finished factor. No update waits, except the
/// first after the factors of M and K have changed, which factorises at rest. Stores two factors.
class RenewedFactor {
 public:
  RenewedFactor(const DeformableBody& body, const Body<Tet4>& rest, const SetupLimits& limits);

  template <class Tetrahedra>
  void update(const Tetrahedra&, const StepFactors& factors, const VectorX& u, bool again) noexcept {
    if (thread_.finished()) {
      if (spare().usable && spare().factors == factors) {
        front_ = 1 - front_;
        ++renewals_;
      }
      thread_.take();
    }
    if (front().factors != factors) {
      make(front(), factors, rest_);
    } else if (again && thread_.idle()) {
      asked_ = u;
      spare().factors = factors;
      thread_.ask();
    }
    corotated_.update(u, front().rotation);
  }
  void apply(const VectorX& r, VectorX& z) const noexcept { corotated_.solve(*made_[front_].factor, r, z); }
  /// Number of factors taken from the thread so far.
  long renewals() const noexcept { return renewals_; }

 private:
  struct RotatingElement {
    std::array<NodeId, 4> nodes;
    Eigen::Matrix<double, 4, 3> gradient;
    double volume;
    LameConstants material;
  };
  struct Made {
    Made(const DeformableBody& body, const EssentialConditions& conditions, const SetupLimits& limits);
    std::unique_ptr<TangentSolver> factor;
    std::vector<Matrix3> rotation;  // of the nodes in the state of the factor
    StepFactors factors;
    bool usable = false;
  };

  Made& front() noexcept { return made_[front_]; }
  Made& spare() noexcept { return made_[1 - front_]; }

  /// A at a state, and its factor.
  void make(Made& made, const StepFactors& factors, const VectorX& u) const noexcept;
  /// Stiffness of one element, as in CorotatedTetrahedra.
  static void add(const RotatingElement& e, double factor, const VectorX& u, BlockMatrix& a) noexcept;

  mutable CorotatedSolve corotated_;
  VectorX lumped_;
  std::vector<RotatingElement> elements_;
  std::array<Made, 2> made_;
  std::size_t front_ = 0;
  VectorX asked_;  // used by the thread while it works
  VectorX rest_;   // no displacement
  long renewals_ = 0;
  RenewalThread thread_;  // last: it uses all other members
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/renewed_factor.ipp>
#endif
