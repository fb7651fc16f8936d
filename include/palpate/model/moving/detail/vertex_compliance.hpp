// The contact compliance of the vertices of a surface that cuts change.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/warped_compliance.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A WarpedCompliance, and vertices that cuts have created or uncovered: each has the compliance of a similar vertex,
/// and once more on its diagonal, because the cut lets it move apart from that. Vertices of the set-up keep their
/// compliance, so that the surface without their present forces does not change. Steps in equilibrium make up for the
/// difference (MovingTissue). Copies share the matrix.
class VertexCompliance {
 public:
  VertexCompliance() = default;
  explicit VertexCompliance(WarpedCompliance all) : all_(std::make_shared<const WarpedCompliance>(std::move(all))) {}
  /// Vertices `similar.size()` in number; vertex i of the matrix has similar[i] = i.
  VertexCompliance(const VertexCompliance& known, std::vector<int> similar)
      : all_(known.all_), similar_(std::move(similar)) {}

  /// Compliance rotated back to the rest configuration [m/N].
  Matrix3 at_rest(std::size_t i, std::size_t j) const noexcept {
    if (similar_.empty()) return all_->at_rest(i, j);
    const auto a = static_cast<std::size_t>(similar_[i]), b = static_cast<std::size_t>(similar_[j]);
    const Matrix3& c = all_->at_rest(a, b);
    return i == j && a != i ? Matrix3(2.0 * c) : c;
  }
  /// Compliance for vertices rotated by `rotation` [m/N].
  Matrix3 rotated(const std::vector<Matrix3>& rotation, int i, int j) const noexcept {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    return rotation[a] * at_rest(a, b) * rotation[b].transpose();
  }
  /// See TissueModel.
  double bound(int j) const noexcept {
    if (similar_.empty()) return all_->bound(j);
    const int source = similar_[static_cast<std::size_t>(j)];
    return (source == j ? 1.0 : 2.0) * all_->bound(source);
  }
  double floor() const noexcept { return all_->floor(); }
  std::size_t bytes() const noexcept { return all_->bytes(); }

 private:
  std::shared_ptr<const WarpedCompliance> all_;
  std::vector<int> similar_;  // empty: every vertex itself
};

}}  // namespace palpate
