// Definitions of compliance_columns.hpp.
#pragma once

#include <palpate/model/static/detail/compliance_columns.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

template <std::floating_point Scalar>
ComplianceColumns<Scalar>::ComplianceColumns(std::vector<Index> kept_index, int slots, const SetupLimits& limits)
    : kept_index_(std::move(kept_index)) {
  limits.require_memory(3.0 * static_cast<double>(kept_index_.size()) * slots * sizeof(Scalar),
                        "the contact compliance");
  values_.assign(3 * kept_index_.size() * static_cast<std::size_t>(slots), Scalar(0));
  bound_.assign(static_cast<std::size_t>(slots), 0.0);
}

template <std::floating_point Scalar>
bool ComplianceColumns<Scalar>::fill(AnyStaticSystem& system, int vertex, int slot, VectorX& column) noexcept {
  bool converged = true;
  for (int c = 0; c < 3; ++c) {
    const Index j = kept_index_[static_cast<std::size_t>(3 * vertex + c)];
    if (j >= 0) converged = system.compliance_column(j, column).converged && converged;
    for (int i = 0; i < vertices(); ++i)
      for (int r = 0; r < 3; ++r) {
        const Index k = kept_index_[static_cast<std::size_t>(3 * i + r)];
        values_[at(i, slot) + static_cast<std::size_t>(3 * c + r)] =
            j < 0 || k < 0 ? Scalar(0) : static_cast<Scalar>(column[k]);
      }
  }
  double largest = 0.0;
  for (int i = 0; i < vertices(); ++i)
    largest = std::max(
        largest, Eigen::Map<const Eigen::Matrix<Scalar, 9, 1>>(block(i, slot)).template cast<double>().squaredNorm());
  bound_[static_cast<std::size_t>(slot)] = std::sqrt(largest);
  return converged;
}

#if !PALPATE_HEADER_ONLY
template class ComplianceColumns<float>;
template class ComplianceColumns<double>;
#endif

}}  // namespace palpate
