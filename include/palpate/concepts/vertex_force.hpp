// Forces on the vertices of a tissue, in the axes of its model.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/small_matrix.hpp>
#include <palpate/core/status.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Geometry>

#include <array>
#include <cstddef>
#include <span>

namespace palpate { inline namespace PALPATE_ABI {

/// A vector in the axes of a model, which are those of its mesh before any pose. Sessions and snapshots use the
/// world frame, so the conversion from a Vector3 is explicit.
class ModelVector {
 public:
  ModelVector() noexcept : v_(0.0, 0.0, 0.0) {}
  ModelVector(double x, double y, double z) noexcept : v_(x, y, z) {}
  explicit ModelVector(const Vector3& in_model_axes) noexcept : v_(in_model_axes) {}
  /// From a vector in the world frame; `to_world` is the model's pose.
  static ModelVector from_world(const Vector3& v, const Eigen::Isometry3d& to_world) noexcept {
    const double* m = to_world.data();  // columns of 4 entries; linear() would add types to every program's compile time
    return {m[0] * v[0] + m[1] * v[1] + m[2] * v[2], m[4] * v[0] + m[5] * v[1] + m[6] * v[2],
            m[8] * v[0] + m[9] * v[1] + m[10] * v[2]};
  }

  const Vector3& in_model_axes() const noexcept { return v_; }
  Vector3 in_world(const Eigen::Isometry3d& to_world) const noexcept {
    const double* m = to_world.data();
    return {m[0] * v_[0] + m[4] * v_[1] + m[8] * v_[2], m[1] * v_[0] + m[5] * v_[1] + m[9] * v_[2],
            m[2] * v_[0] + m[6] * v_[1] + m[10] * v_[2]};
  }

  ModelVector& operator+=(const ModelVector& other) noexcept {
    v_ = v_ + other.v_;
    return *this;
  }
  friend bool operator==(const ModelVector& a, const ModelVector& b) noexcept {
    return a.v_[0] == b.v_[0] && a.v_[1] == b.v_[1] && a.v_[2] == b.v_[2];
  }

 private:
  Vector3 v_;
};

/// A force on one vertex of the touchable surface, as models take it.
struct VertexForce {
  int vertex = -1;
  ModelVector force{};  ///< on the tissue [N]
};

namespace detail {

/// Copies the finite ones of these forces; `count` is how many there are then. Flags non_finite_force where some are
/// not finite, degraded_model where there are more than `to` has room for.
inline Status copy_finite(std::span<const VertexForce> forces, std::span<VertexForce> to, std::size_t& count) noexcept {
  Status status;
  count = 0;
  for (const VertexForce& f : forces)
    if (!all_finite(f.force.in_model_axes()))
      status.set(StatusFlag::non_finite_force);
    else if (count < to.size())
      to[count++] = f;
    else
      status.set(StatusFlag::degraded_model);
  return status;
}

}  // namespace detail

/// A force on one point of the touchable surface. The vertices of its facet share it by the weights, which add up to 1.
struct PointForce {
  std::array<int, 3> vertices{-1, -1, -1};
  std::array<double, 3> weights{};
  ModelVector force{};   ///< on the tissue [N]
  bool grasped = false;  ///< also pulled back
  bool slides = false;   ///< without friction
};

}}  // namespace palpate
