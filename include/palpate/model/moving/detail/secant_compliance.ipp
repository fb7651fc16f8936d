// Definitions of secant_compliance.hpp.
#pragma once

#include <palpate/model/moving/detail/secant_compliance.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double SecantTerms::bound(std::size_t j) const noexcept {
  double largest = 0.0;
  for (std::size_t k = 0; k < count; ++k) {
    largest += term[k].largest_a * term[k].s[j].norm() + term[k].largest_s * term[k].w[j].norm();
  }
  return largest;
}

PALPATE_INLINE SecantCompliance::SecantCompliance(std::size_t vertices, std::size_t most_forces) {
  for (Pair& pair : pair_) {
    pair.force.reserve(2 * most_forces);
    pair.moved.resize(vertices);
  }
}

PALPATE_INLINE void SecantCompliance::Pair::add(int vertex, const Vector3& f) noexcept {
  const auto same = std::ranges::find(force, vertex, &VertexForce::vertex);
  if (same != force.end())
    same->force += ModelVector(f);
  else
    force.push_back({vertex, ModelVector(f)});
}

PALPATE_INLINE bool SecantCompliance::record(std::span<const VertexForce> before, std::span<const VertexForce> after,
                                             std::span<const Vector3> from, std::span<const Vector3> to,
                                             double error) noexcept {
  if (count_ == pair_.size())
    std::rotate(pair_.begin(), pair_.begin() + 1, pair_.end());
  else
    ++count_;
  Pair& pair = pair_[count_ - 1];
  pair.force.clear();
  for (const VertexForce& f : after) pair.add(f.vertex, f.force.in_model_axes());
  double size = 0.0, change = 0.0, product = 0.0;
  for (const VertexForce& f : pair.force) size += f.force.in_model_axes().squaredNorm();
  for (const VertexForce& f : before) pair.add(f.vertex, -f.force.in_model_axes());
  for (std::size_t i = 0; i < to.size(); ++i) pair.moved[i] = to[i] - from[i];
  for (const VertexForce& f : pair.force) {
    change += f.force.in_model_axes().squaredNorm();
    product += f.force.in_model_axes().dot(pair.moved[static_cast<std::size_t>(f.vertex)]);
  }
  const double least = std::max(smallest_change, smallest_change_of_error * error);
  if (change > least * least * size && product > 0.0) return true;
  --count_;
  return false;
}

PALPATE_INLINE double SecantCompliance::work_ratio(const VertexCompliance& compliance,
                                                   const std::vector<Matrix3>& rotation) const noexcept {
  if (count_ == 0) return 1.0;
  const Pair& pair = pair_[count_ - 1];
  double product = 0.0;
  for (const VertexForce& f : pair.force)
    product += f.force.in_model_axes().dot(pair.moved[static_cast<std::size_t>(f.vertex)]);
  const double own = compliance.work(rotation, pair.force);
  return own > 0.0 ? product / own : 1.0;
}

PALPATE_INLINE void SecantCompliance::find_terms(const VertexCompliance& compliance,
                                                 const std::vector<Matrix3>& rotation,
                                                 SecantTerms& terms) const noexcept {
  terms.count = 0;
  for (std::size_t k = 0; k < count_; ++k) {
    const Pair& pair = pair_[k];
    SecantTerms::Term& term = terms.term[terms.count];
    for (std::size_t i = 0; i < pair.moved.size(); ++i) {
      Vector3 w = Vector3::Zero();
      for (const VertexForce& f : pair.force) {
        const auto j = static_cast<std::size_t>(f.vertex);
        w += compliance.rotated(rotation, static_cast<int>(i), f.vertex) * f.force.in_model_axes();
        w += terms(i, j) * f.force.in_model_axes();
      }
      term.w[i] = w;
    }
    double product = 0.0, own = 0.0;
    for (const VertexForce& f : pair.force) {
      const auto j = static_cast<std::size_t>(f.vertex);
      product += f.force.in_model_axes().dot(pair.moved[j]);
      own += f.force.in_model_axes().dot(term.w[j]);
    }
    if (!(product > 0.1 * own) || !(own > 0.1 * product)) continue;
    std::ranges::copy(pair.moved, term.s.begin());
    term.largest_s = term.largest_a = 0.0;
    for (std::size_t i = 0; i < term.s.size(); ++i) {
      term.w[i] /= product;
      term.a[i] = (1.0 + own / product) / product * term.s[i] - term.w[i];
      term.largest_s = std::max(term.largest_s, term.s[i].norm());
      term.largest_a = std::max(term.largest_a, term.a[i].norm());
    }
    ++terms.count;
  }
}

}}}  // namespace palpate::detail
