// A factor that a thread of its own makes anew while steps go on with the last one.
#pragma once

#include <palpate/assembly/constant_geometry.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/model/step_preconditioners.hpp>

#include <atomic>
#include <thread>

namespace palpate { inline namespace PALPATE_ABI {

/// Preconditioner of CorotatedMotion: the factor of A at a recent state, turned on from there with the nodes,
/// (R R_s^T) A_s^-1 (R R_s^T)^T (asynchronous preconditioning, Courtecuisse et al. 2010). When it is due and the thread
/// is free, an update hands it the state; a finished factor is taken in by the next update. No update waits, but for
/// the first after the factors of M and K have changed, which factorises at rest. Two factors are held.
class RenewedFactor {
 public:
  RenewedFactor(const DeformableBody& body, const Body<Tet4>& rest, const SetupLimits& limits)
      : turned_(body),
        lumped_(body.lumped),
        made_{{Made(body, turned_.conditions(), limits), Made(body, turned_.conditions(), limits)}},
        asked_(VectorX::Zero(3 * lumped_.size())),
        rest_(asked_) {
    for (Index e = 0; e < rest.mesh.element_count(); ++e) {
      const PointGeometry<Tet4> g = constant_geometry<Tet4>(rest.mesh, e);
      elements_.push_back({rest.mesh.elements[static_cast<std::size_t>(e)], g.gradient, g.volume,
                           *lame_constants(rest.elasticity[rest.region_of(e)])});  // Corotational is isotropic
    }
    thread_ = std::thread([this] { work(); });
  }
  ~RenewedFactor() {
    state_.store(State::stopped, std::memory_order_release);
    state_.notify_one();
    thread_.join();
  }
  RenewedFactor(const RenewedFactor&) = delete;
  RenewedFactor& operator=(const RenewedFactor&) = delete;

  template <class Tetrahedra>
  void update(const Tetrahedra&, const StepFactors& factors, const VectorX& u, bool anew) noexcept {
    const State state = state_.load(std::memory_order_acquire);
    if (state == State::ready) {
      if (spare().usable && spare().factors == factors) {
        front_ = 1 - front_;
        ++renewals_;
      }
      state_.store(State::idle, std::memory_order_relaxed);
    }
    if (front().factors != factors) {
      make(front(), factors, rest_);
    } else if (anew && state != State::asked) {
      asked_ = u;
      spare().factors = factors;
      state_.store(State::asked, std::memory_order_release);
      state_.notify_one();
    }
    turned_.turn(u, front().turn);
  }
  void apply(const VectorX& r, VectorX& z) const noexcept { turned_.solve(*made_[front_].factor, r, z); }
  /// Factors of the thread taken in so far.
  long renewals() const noexcept { return renewals_; }

 private:
  enum class State { idle, asked, ready, stopped };
  struct TurningElement {
    std::array<NodeId, 4> nodes;
    Eigen::Matrix<double, 4, 3> gradient;
    double volume;
    LameConstants law;
  };
  struct Made {
    Made(const DeformableBody& body, const EssentialConditions& conditions, const SetupLimits& limits)
        : factor(std::make_unique<TangentSolver>(body.pattern, conditions, body.positions, limits)),
          turn(body.positions.size(), Matrix3::Identity()) {}
    std::unique_ptr<TangentSolver> factor;
    std::vector<Matrix3> turn;  // of the nodes at its state
    StepFactors factors;
    bool usable = false;
  };

  Made& front() noexcept { return made_[front_]; }
  Made& spare() noexcept { return made_[1 - front_]; }

  void work() noexcept {
    for (;;) {
      state_.wait(State::idle, std::memory_order_acquire);
      switch (state_.load(std::memory_order_acquire)) {
        case State::stopped:
          return;
        case State::asked: {
          Made& made = spare();  // the front stays where it is until this one is ready
          make(made, made.factors, asked_);
          State expected = State::asked;
          state_.compare_exchange_strong(expected, State::ready, std::memory_order_acq_rel);
          break;
        }
        case State::ready:
          state_.wait(State::ready, std::memory_order_acquire);
          break;
        case State::idle:
          break;
      }
    }
  }

  /// A at a state, and its factor.
  void make(Made& made, const StepFactors& factors, const VectorX& u) const noexcept {
    turned_.fit(u, made.turn);
    BlockMatrix& a = made.factor->matrix();
    a.set_zero();
    for (const TurningElement& e : elements_) add(e, factors.stiffness, u, a);
    a.add_nodal(factors.mass, lumped_);
    made.usable = made.factor->factorise();
    made.factors = factors;
  }
  /// R K R^T of one element.
  static void add(const TurningElement& e, double factor, const VectorX& u, BlockMatrix& a) noexcept {
    Matrix3 f = Matrix3::Identity();
    for (int n = 0; n < 4; ++n)
      f.noalias() += u.segment<3>(3 * Index{e.nodes[static_cast<std::size_t>(n)]}) * e.gradient.row(n);
    if (!f.allFinite()) f.setIdentity();
    const Eigen::Matrix<double, 4, 3> g = e.gradient * matrix3(closest_rotation(tensor3<double>(f))).transpose();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j) {
        const NodeId row = e.nodes[static_cast<std::size_t>(i)], column = e.nodes[static_cast<std::size_t>(j)];
        if (column > row) continue;
        Matrix3 block = Matrix3::Zero();
        add_isotropic_block(e.law, g.row(i), g.row(j), block.data());
        a.block(a.pattern().find(row, column)) += factor * e.volume * block;
      }
  }

  mutable TurnedSolve turned_;
  VectorX lumped_;
  std::vector<TurningElement> elements_;
  std::array<Made, 2> made_;
  std::size_t front_ = 0;
  VectorX asked_;  // the thread's while it is asked
  VectorX rest_;   // no displacement
  long renewals_ = 0;
  std::atomic<State> state_{State::idle};
  std::thread thread_;  // last: it uses all the others
};

}}  // namespace palpate
