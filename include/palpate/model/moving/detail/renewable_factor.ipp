// Definitions of renewable_factor.hpp.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/model/moving/detail/renewable_factor.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE RenewableFactor::RenewableFactor(const DeformableBody& body, BlockMatrix stiffness,
                                                const std::vector<NodeId>& last, StiffnessAt stiffness_at,
                                                const SetupLimits& limits)
    : lumped_(body.lumped),
      stiffness_(std::move(stiffness)),
      is_uneven_(contrast() > uneven_contrast),
      corotated_(body, is_uneven_ ? &stiffness_ : nullptr),
      stiffness_at_(std::move(stiffness_at)) {
  front() = make_shape(body, last, limits);
  if (!stiffness_at_) return;
  spare() = make_shape(body, last, limits);
  asked_ = VectorX::Zero(stiffness_.size());
  thread_.emplace([this] { renew(); });
}

PALPATE_INLINE RenewableFactor::Shape RenewableFactor::make_shape(const DeformableBody& body,
                                                                  const std::vector<NodeId>& last,
                                                                  const SetupLimits& limits) const {
  Shape made;
  made.factor = std::make_unique<TangentSolver>(stiffness_.pattern(), corotated_.conditions(), body.positions, limits,
                                                FactorScalar::single_precision, last);
  made.rotation.assign(body.positions.size(), Matrix3::Identity());
  return made;
}

PALPATE_INLINE double RenewableFactor::contrast() const noexcept {
  double smallest = infinity, largest = 0.0;
  for (Index i = 0; i < lumped_.size(); ++i) {
    const double stiffness = stiffness_.block(stiffness_.pattern().diagonal(i)).trace();
    if (!(lumped_[i] > 0.0) || !(stiffness > 0.0)) continue;
    const double modulus = stiffness / std::cbrt(lumped_[i]);  // stiffness: modulus times size
    smallest = std::min(smallest, modulus);
    largest = std::max(largest, modulus);
  }
  return largest > 0.0 ? largest / smallest : 1.0;
}

PALPATE_INLINE bool RenewableFactor::set_mass(double mass) noexcept {
  Shape& made = front();
  if (made.usable && mass == made.mass) return true;
  made.mass = mass;
  made.factor->matrix().copy_values(stiffness_);
  if (mass > 0.0) made.factor->matrix().add_nodal(mass, lumped_);
  std::ranges::fill(made.rotation, Matrix3::Identity());
  made.is_at_rest = true;
  made.usable = made.factor->factorise();
  return made.usable;
}

PALPATE_INLINE void RenewableFactor::rotate(const VectorX& u, bool stretched) noexcept {
  if (stretched && front().is_at_rest)
    corotated_.update_stretched(u);
  else
    corotated_.update(u, front().rotation);
}

PALPATE_INLINE void RenewableFactor::take_renewed() noexcept {
  if (!thread_ || !thread_->finished()) return;
  if (spare().usable && spare().mass == front().mass) {
    front_ = 1 - front_;
    ++renewals_;
  }
  thread_->set_idle();
}

PALPATE_INLINE void RenewableFactor::ask(const VectorX& u) noexcept {
  if (!thread_ || !thread_->idle()) return;
  asked_ = u;
  spare().mass = front().mass;
  thread_->ask();
}

PALPATE_INLINE Matrix3 RenewableFactor::diagonal(NodeId node) const noexcept {
  return stiffness_.block(stiffness_.pattern().diagonal(node)) +
         shapes_[front_].mass * lumped_[node] * Matrix3::Identity();
}

PALPATE_INLINE void RenewableFactor::renew() noexcept {
  Shape& made = spare();
  made.usable = false;
  if (!find_stiffness(made.factor->matrix())) return;  // the last factor stays in use
  if (made.mass > 0.0) made.factor->matrix().add_nodal(made.mass, lumped_);
  corotated_.fit(asked_, made.rotation);
  made.is_at_rest = false;
  made.usable = made.factor->factorise();
}

PALPATE_INLINE bool RenewableFactor::find_stiffness(BlockMatrix& k) noexcept {
  bool found = false;
  attempt([&] { found = stiffness_at_(asked_, k); });  // not without memory
  return found;
}

}}}  // namespace palpate::detail
