// The contact compliance of the vertices of a surface that cuts change.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/warped_compliance.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A WarpedCompliance C0, and vertices that cuts have created or uncovered: each has the compliance of a similar
/// vertex, and once more on its diagonal where several have the same, because they move apart. Beside a slit it is
/// C0_ij + s_i s_j C0_ij, with s = 1 on one lip, -1 on the other one, and less away from them: a lip moves twice as far
/// as before under its own forces and not at all under those of the opposite lip, while equal forces on both have the
/// same effect as before. For a symmetric body cut in half that is the method of images. Steps in equilibrium make up
/// for the difference from the body that is left (MovingTissue). Copies share the matrix.
class VertexCompliance {
 public:
  VertexCompliance() = default;
  explicit VertexCompliance(WarpedCompliance all) : all_(std::make_shared<const WarpedCompliance>(std::move(all))) {}
  /// Vertices `similar.size()` in number, and `side` s of each; vertex i of the matrix has similar[i] = i.
  VertexCompliance(const VertexCompliance& known, std::vector<int> similar, std::vector<double> side)
      : all_(known.all_), scale_(known.scale_), similar_(std::move(similar)), side_(std::move(side)) {}

  /// Compliance rotated back to the rest configuration [m/N].
  Matrix3 at_rest(std::size_t i, std::size_t j) const noexcept {
    if (similar_.empty()) return scale_ * all_->at_rest(i, j);
    const auto a = static_cast<std::size_t>(similar_[i]), b = static_cast<std::size_t>(similar_[j]);
    const double own = i == j && a != i && side_[i] == 0.0 ? 1.0 : 0.0;
    return scale_ * (1.0 + side_[i] * side_[j] + own) * all_->at_rest(a, b);
  }
  /// Compliance for vertices rotated by `rotation` [m/N].
  Matrix3 rotated(const std::vector<Matrix3>& rotation, int i, int j) const noexcept {
    const auto a = static_cast<std::size_t>(i), b = static_cast<std::size_t>(j);
    return rotation[a] * at_rest(a, b) * rotation[b].transpose();
  }
  /// See TissueModel.
  double bound(int j) const noexcept {
    if (similar_.empty()) return scale_ * all_->bound(j);
    const auto i = static_cast<std::size_t>(j);
    return scale_ * (similar_[i] == j && side_[i] == 0.0 ? 1.0 : 2.0) * all_->bound(similar_[i]);
  }
  bool is_beside_slit(std::size_t i) const noexcept { return !side_.empty() && side_[i] != 0.0; }
  double floor() const noexcept { return scale_ * all_->floor(); }
  /// All of it relative to the settled state: tissue that is pressed deep is stiffer.
  double scale() const noexcept { return scale_; }
  void set_scale(double scale) noexcept { scale_ = scale; }
  std::size_t bytes() const noexcept { return all_->bytes(); }

 private:
  std::shared_ptr<const WarpedCompliance> all_;
  double scale_ = 1.0;
  std::vector<int> similar_;  // empty: every vertex itself
  std::vector<double> side_;
};

}}  // namespace palpate
