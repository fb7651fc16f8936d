// Forces on the vertices of a tissue, in the axes of its model.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <Eigen/Geometry>

namespace palpate { inline namespace PALPATE_ABI {

/// A vector in the axes of a model, which are those of its mesh before any pose. Sessions and snapshots use the
/// world frame, so the conversion from a Vector3 is explicit.
class ModelVector {
 public:
  ModelVector() noexcept : v_(Vector3::Zero()) {}
  ModelVector(double x, double y, double z) noexcept : v_(x, y, z) {}
  explicit ModelVector(const Vector3& in_model_axes) noexcept : v_(in_model_axes) {}
  /// From a vector in the world frame; `to_world` is the model's pose.
  static ModelVector from_world(const Vector3& v, const Eigen::Isometry3d& to_world) noexcept {
    return ModelVector(to_world.linear().transpose() * v);
  }

  const Vector3& in_model_axes() const noexcept { return v_; }
  Vector3 in_world(const Eigen::Isometry3d& to_world) const noexcept { return to_world.linear() * v_; }

  ModelVector& operator+=(const ModelVector& other) noexcept {
    v_ += other.v_;
    return *this;
  }
  friend bool operator==(const ModelVector& a, const ModelVector& b) noexcept { return a.v_ == b.v_; }

 private:
  Vector3 v_;
};

/// A force on one vertex of the touchable surface, as models take it.
struct VertexForce {
  int vertex = -1;
  ModelVector force{};  ///< on the tissue [N]
};

}}  // namespace palpate
