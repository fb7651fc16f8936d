// The contact compliance of the vertices of a moving surface, which cuts may change.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/detail/nodal_rotation.hpp>

#include <algorithm>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Displacement of touchable vertices within a step per force on another, computed in the settled state and rotated
/// with the vertices: C_ij = R_i C0_ij R_j^T (compliance warping, Saupin et al. 2008). Stores 72 bytes per pair of
/// vertices.
class WarpedCompliance {
 public:
  WarpedCompliance() = default;
  /// Computes the compliance of a motion in its current state for steps of h [s]: one `respond` per dof of `nodes`.
  /// Throws too_large, not_positive_definite for a body without stiffness, not_converged when a response was not found.
  template <class Motion>
  WarpedCompliance(Motion& motion, double h, const std::vector<NodeId>& nodes, const NodalRotations& rotations,
                   const SetupLimits& limits)
      : count_(nodes.size()) {
    limits.require_memory(static_cast<double>(count_) * static_cast<double>(count_) * sizeof(Matrix3),
                          "the contact compliance");
    rest_.resize(count_ * count_);
    if (!motion.prepare_response(h)) raise(SetupErrorKind::not_positive_definite, "the body at rest has no stiffness");
    std::vector<Matrix3> rotated(count_);
    for (std::size_t i = 0; i < count_; ++i) rotated[i] = rotations(i, motion.displacement());
    VectorX force = VectorX::Zero(motion.displacement().size()), u(force.size());
    for (std::size_t j = 0; j < count_; ++j) {
      if (j % 64 == 0) limits.advance("compliance", static_cast<double>(j) / static_cast<double>(count_));
      for (int c = 0; c < 3; ++c) {
        force[3 * Index{nodes[j]} + c] = 1.0;
        if (!motion.respond(force, u))
          raise_at(SetupIds::nodes, nodes[j], SetupErrorKind::not_converged, "the compliance of a node was not found",
                   "Shorten the step, or choose another preconditioner");
        force[3 * Index{nodes[j]} + c] = 0.0;
        for (std::size_t i = 0; i < count_; ++i)
          for (int d = 0; d < 3; ++d) rest_[i + count_ * j](d, c) = u[3 * Index{nodes[i]} + d];
      }
      for (std::size_t i = 0; i < count_; ++i)
        rest_[i + count_ * j] = rotated[i].transpose() * rest_[i + count_ * j] * rotated[j];
    }
    find_bounds();
  }

  /// Compliance rotated back to the rest configuration [m/N].
  const Matrix3& at_rest(std::size_t i, std::size_t j) const noexcept { return rest_[i + count_ * j]; }
  /// See TissueModel.
  double bound(int j) const noexcept { return bound_[static_cast<std::size_t>(j)]; }
  double floor() const noexcept { return floor_; }
  std::size_t bytes() const noexcept { return rest_.size() * sizeof(Matrix3); }

 private:
  void find_bounds();

  std::size_t count_ = 0;
  std::vector<Matrix3> rest_;  // of vertex i per force on j, at index i + count x j
  std::vector<double> bound_;
  double floor_ = 0.0;
};

inline void WarpedCompliance::find_bounds() {
  bound_.assign(count_, 0.0);
  for (std::size_t j = 0; j < count_; ++j) {
    for (std::size_t i = 0; i < count_; ++i) bound_[j] = std::max(bound_[j], at_rest(i, j).norm());
    floor_ = std::max(floor_, 1e-9 * bound_[j]);
  }
  if (floor_ == 0.0) floor_ = 1e-9;
}

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
  /// Sum of f_i . C_ij f_j over forces on vertices rotated by `rotation`: twice the energy that they store [J].
  /// O(forces^2).
  double work(const std::vector<Matrix3>& rotation, std::span<const VertexForce> forces) const noexcept {
    double sum = 0.0;
    for (const VertexForce& f : forces)
      for (const VertexForce& g : forces)
        sum += f.force.in_model_axes().dot(rotated(rotation, f.vertex, g.vertex) * g.force.in_model_axes());
    return sum;
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

}}}  // namespace palpate::detail
