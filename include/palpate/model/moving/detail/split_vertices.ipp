#pragma once

#include <palpate/model/moving/detail/split_vertices.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE SplitVertices::SplitVertices(std::span<const int> parent, std::size_t known,
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

PALPATE_INLINE std::size_t SplitVertices::divide(std::span<VertexForce> forces, std::size_t count) const noexcept {
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
