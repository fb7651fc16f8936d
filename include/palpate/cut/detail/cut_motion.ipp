// Definitions of cut_motion.hpp.
#pragma once

#include <palpate/core/detail/attempt.hpp>
#include <palpate/cut/detail/cut_motion.hpp>

#include <Eigen/LU>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE CutFactor::CutFactor(std::shared_ptr<RenewableFactor> base)
    : base_(std::move(base)), whole_(base_), thread_([this] { compute(); }) {
  find_base_nodes();
}

PALPATE_INLINE void CutFactor::follow(std::shared_ptr<const CutBody> body) {
  newest_ = std::move(body);
  find_base_nodes();
  if (thread_.idle()) request();
}

PALPATE_INLINE void CutFactor::restart() {
  newest_.reset();
  base_ = whole_;
  request_.wanted = false;
  find_base_nodes();
}

PALPATE_INLINE void CutFactor::request() {
  request_.body = newest_;
  request_.mass = mass_;
  request_.wanted = true;
  thread_.ask();
}

PALPATE_INLINE void CutFactor::find_base_nodes() {
  const auto nodes = static_cast<NodeId>(base_->nodes());
  base_node_.resize(newest_ ? newest_->copied_from.size() : static_cast<std::size_t>(nodes));
  for (std::size_t i = 0; i < base_node_.size(); ++i) {
    auto node = static_cast<NodeId>(i);
    while (node >= nodes) node = newest_->copied_from[static_cast<std::size_t>(node)];
    base_node_[i] = node;
  }
  std::vector<int> copies(static_cast<std::size_t>(nodes), 0);
  for (const NodeId node : base_node_) ++copies[static_cast<std::size_t>(node)];
  split_.clear();
  relative_.clear();
  for (std::size_t i = 0; i < base_node_.size(); ++i)
    if (copies[static_cast<std::size_t>(base_node_[i])] > 1) {
      split_.push_back(static_cast<NodeId>(i));
      const Matrix3 inverse = base_->diagonal(base_node_[i]).inverse();
      relative_.push_back(all_finite(inverse) ? inverse : Matrix3(Matrix3::Zero()));
    }
  base_r_ = base_z_ = VectorX::Zero(3 * Index{nodes});
}

PALPATE_INLINE bool CutFactor::set_mass(double mass) noexcept {
  mass_ = mass;
  return base_->set_mass(mass);
}

PALPATE_INLINE void CutFactor::rotate(const VectorX& u, bool stretched) noexcept {
  base_z_ = u.head(base_z_.size());  // nodes that exist in the base keep their ids
  base_->rotate(base_z_, stretched);
}

PALPATE_INLINE void CutFactor::solve(const VectorX& r, VectorX& z) noexcept {
  base_r_.setZero();
  for (std::size_t i = 0; i < base_node_.size(); ++i)
    add_node_vector(base_r_, Index{base_node_[i]}, node_vector(r, static_cast<Index>(i)));
  base_->solve(base_r_, base_z_);
  for (std::size_t i = 0; i < base_node_.size(); ++i)
    set_node_vector(z, static_cast<Index>(i), node_vector(base_z_, Index{base_node_[i]}));
  for (std::size_t k = 0; k < split_.size(); ++k)
    add_node_vector(z, Index{split_[k]}, relative_[k] * node_vector(r, Index{split_[k]}));
}

PALPATE_INLINE void CutFactor::apply(const VectorX& x, VectorX& y) noexcept {
  base_z_ = x.head(base_z_.size());
  base_->apply(base_z_, base_r_);
  y.setZero();
  y.head(base_r_.size()) = base_r_;
}

PALPATE_INLINE void CutFactor::take_renewed() noexcept {
  if (!thread_.finished()) return;
  thread_.set_idle();
  if (request_.wanted && request_.made && request_.made->set_mass(mass_)) {
    base_ = std::move(request_.made);
    find_base_nodes();
    ++renewals_;
  }
  if (newest_ && (request_.body != newest_ || !request_.wanted)) request();
}

PALPATE_INLINE void CutFactor::compute() noexcept {
  // No memory: the last factor stays in use.
  if (!attempt([&] { request_.made = make(); })) request_.made.reset();
}

PALPATE_INLINE std::shared_ptr<RenewableFactor> CutFactor::make() const {
  auto made = std::make_shared<RenewableFactor>(request_.body->body, request_.body->stiffness(), std::vector<NodeId>{},
                                                StiffnessAt(), SetupLimits{});
  return made->set_mass(request_.mass) ? made : nullptr;
}

}}}  // namespace palpate::detail
