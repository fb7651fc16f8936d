// Where a surface under known forces is, for the search for contacts.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/contact/detail/bvh.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// A surface as forces of a known time deform it. A tissue that moves knows it; the forces of the next ticks differ
/// little from those, so that a search around these positions is as wide as the surface moves between two updates, and
/// not as deep as the tools press. It is a place to start from, not an assumption: a search adds how far the loaded
/// vertices have moved away from it.
class ExpectedSurface {
 public:
  /// Without vertices: nothing is expected.
  ExpectedSurface() = default;

  bool is_known() const noexcept { return !positions_.empty(); }
  const Vector3& position(int v) const noexcept { return positions_[static_cast<std::size_t>(v)]; }
  const Bvh& bvh() const noexcept { return bvh_; }
  /// The vertices with forces.
  std::span<const int> loaded() const noexcept { return {loaded_.data(), count_}; }

  /// Sets positions and forces. `resting`: of the same triangles. Allocates at the first call and when there are more
  /// vertices than before. O(vertices + triangles).
  void set(const Bvh& resting, std::span<const Triangle> triangles, std::span<const Vector3> positions,
           std::span<const VertexForce> forces) {
    if (positions_.size() != positions.size()) {
      positions_.resize(positions.size());
      loaded_.resize(positions.size());
      bvh_ = resting;
    }
    std::copy(positions.begin(), positions.end(), positions_.begin());
    bvh_.refit(triangles, positions_);
    count_ = std::min(forces.size(), loaded_.size());
    for (std::size_t k = 0; k < count_; ++k) loaded_[k] = forces[k].vertex;
  }

 private:
  std::vector<Vector3> positions_;
  Bvh bvh_;
  std::vector<int> loaded_;  // the first count_
  std::size_t count_ = 0;
};

}}  // namespace palpate
