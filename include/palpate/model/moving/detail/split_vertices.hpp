// Forces on vertices that a cut has split, divided among the new vertices.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

#include <algorithm>
#include <functional>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A tick presses the surface of before a cut: the whole force of a vertex that the cut splits would stay on one lip.
class SplitVertices {
 public:
  SplitVertices() = default;
  /// The shares are proportional to the masses of the nodes: the area that a vertex stands for is divided like the
  /// elements around it. `parent`: per vertex the vertex that it was split from, -1 without one; the first `known`
  /// vertices are those of before. `mass` of a vertex [kg]. Allocates.
  SplitVertices(std::span<const int> parent, std::size_t known, const std::function<double(int)>& mass);

  /// The first `count` of `forces` [N] are divided; parts on new vertices are appended while there is room. Returns the
  /// new count. The sum of the forces stays.
  std::size_t divide(std::span<VertexForce> forces, std::size_t count) const noexcept;

 private:
  struct Share {
    int parent, vertex;
    double share;  // of the force on the parent
  };
  std::vector<Share> shares_;  // sorted by parent
};

inline SplitVertices::SplitVertices(std::span<const int> parent, std::size_t known,
                                    const std::function<double(int)>& mass) {
  for (std::size_t v = known; v < parent.size(); ++v)
    if (parent[v] >= 0 && static_cast<std::size_t>(parent[v]) < known)
      shares_.push_back({parent[v], static_cast<int>(v), 0.0});
  std::ranges::stable_sort(shares_, {}, &Share::parent);
  for (auto first = shares_.begin(); first != shares_.end();) {
    const auto last = std::find_if(first, shares_.end(), [&](const Share& s) { return s.parent != first->parent; });
    double all = mass(first->parent);
    for (auto s = first; s != last; ++s) all += mass(s->vertex);
    for (; first != last; ++first) first->share = all > 0.0 ? mass(first->vertex) / all : 0.0;
  }
}

inline std::size_t SplitVertices::divide(std::span<VertexForce> forces, std::size_t count) const noexcept {
  const std::size_t before = count;
  for (std::size_t k = 0; k < before; ++k) {
    const int parent = forces[k].vertex;
    const Vector3 whole = forces[k].force.in_model_axes();
    double left = 1.0;
    for (auto s = std::ranges::lower_bound(shares_, parent, {}, &Share::parent);
         s != shares_.end() && s->parent == parent && count < forces.size(); ++s) {
      forces[count++] = {s->vertex, ModelVector(s->share * whole)};
      left -= s->share;
    }
    forces[k].force = ModelVector(left * whole);
  }
  return count;
}

}}}  // namespace palpate::detail
