// Small strain as an ElasticForces body.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/elastic_forces.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// f = K u with a constant stiffness. Valid for small displacements only; never reports inverted elements.
class LinearForces final : public ElasticForces {
 public:
  explicit LinearForces(BlockMatrix stiffness) : stiffness_(std::move(stiffness)), force_(stiffness_.size()) {}

  Index size() const noexcept override { return stiffness_.size(); }
  double energy(const VectorX& u) const noexcept override;
  DeformationReport force(const VectorX& u, VectorX& f) const noexcept override;
  void tangent(const VectorX&, BlockMatrix& k) const noexcept override { k.copy_values(stiffness_); }
  /// Any length is suitable, because the force is linear.
  double probe_length() const noexcept { return 1.0; }
  bool is_linear() const noexcept override { return true; }

 private:
  BlockMatrix stiffness_;
  mutable VectorX force_;
};

static_assert(ForceOperator<LinearForces>);

inline double LinearForces::energy(const VectorX& u) const noexcept {
  stiffness_.apply(u, force_);
  return 0.5 * u.dot(force_);
}

inline DeformationReport LinearForces::force(const VectorX& u, VectorX& f) const noexcept {
  stiffness_.apply(u, f);
  DeformationReport report;
  report.smallest_volume_ratio = 1.0;
  return report;
}

}}  // namespace palpate
