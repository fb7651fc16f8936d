// Definitions of subfacet_compliance.hpp.
#pragma once

#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/contact/subfacet_compliance.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE SubfacetCompliance::SubfacetCompliance(const detail::ProjectedHalfSpace& table) {
  std::vector<std::vector<Block>> of(at(table.vertex_count()));
  for (int i = 0; i < table.vertex_count(); ++i) {
    vertices_.push_back(table.vertex(i));
    for (std::size_t k = 0; k < table.columns(i).size(); ++k) {
      const int j = table.columns(i)[k];
      of[at(j)].push_back({i, table.blocks(i)[k]});
      if (i != j) of[at(i)].push_back({j, table.blocks(i)[k].transpose()});
    }
  }
  first_.assign(1, 0);
  for (const auto& blocks : of) {
    blocks_.insert(blocks_.end(), blocks.begin(), blocks.end());
    first_.push_back(static_cast<int>(blocks_.size()));
  }
  index_blocks();
}

PALPATE_INLINE SubfacetCompliance::SubfacetCompliance(const SubfacetCompliance& whole, std::span<const Copy> vertices) {
  std::vector<std::vector<int>> copies(whole.vertices_.size());
  for (std::size_t v = 0; v < vertices.size(); ++v)
    if (const int origin = vertices[v].origin; origin >= 0) copies[at(origin)].push_back(static_cast<int>(v));
  first_.assign(1, 0);
  for (const Copy& copy : vertices) {
    detail::HalfSpacePoint& p =
        vertices_.emplace_back(copy.origin >= 0 ? whole.vertex(copy.origin) : detail::HalfSpacePoint{});
    p.is_disturbed = p.is_disturbed || copy.is_changed;
    for (const Block& block : copy.origin >= 0 ? whole.blocks(copy.origin) : std::span<const Block>{})
      for (const int other : copies[at(block.vertex)]) blocks_.push_back({other, block.shown});
    first_.push_back(static_cast<int>(blocks_.size()));
  }
  has_copies_ = whole.has_copies_ || std::ranges::any_of(copies, [](const auto& all) { return all.size() > 1; });
  index_blocks();
}

/// By insertion: only those of a surface after cuts are not in order.
PALPATE_INLINE void SubfacetCompliance::index_blocks() {
  for (std::size_t v = 0; v + 1 < first_.size(); ++v)
    for (std::size_t k = at(first_[v]) + 1; k < at(first_[v + 1]); ++k) {
      const Block block = blocks_[k];
      std::size_t place = k;
      for (; place > at(first_[v]) && blocks_[place - 1].vertex > block.vertex; --place)
        blocks_[place] = blocks_[place - 1];
      blocks_[place] = block;
    }
  block_vertex_.reserve(blocks_.size());
  for (const Block& block : blocks_) block_vertex_.push_back(block.vertex);
}

PALPATE_INLINE const SubfacetCompliance::Block* SubfacetCompliance::find(int i, int j) const noexcept {
  const std::span<const int> vertices = vertices_of_blocks(j);
  const auto found = std::ranges::lower_bound(vertices, i);
  return found != vertices.end() && *found == i ? &blocks(j)[static_cast<std::size_t>(found - vertices.begin())]
                                                : nullptr;
}

PALPATE_INLINE bool SubfacetCompliance::knows(const detail::ContactSample& sample) const noexcept {
  bool any = false;
  for (std::size_t a = 0; a < 3; ++a) {
    if (sample.weights[a] == 0.0) continue;
    const detail::HalfSpacePoint& own = vertex(sample.vertices[a]);
    if (!own.is_known() && !own.is_fixed) return false;
    any = any || own.is_known();
  }
  return any;
}

PALPATE_INLINE detail::HalfSpacePoint SubfacetCompliance::point(const detail::ContactSample& sample,
                                                                const Vector3& normal) const noexcept {
  constexpr double beside = 0.25;  // of a facet
  detail::HalfSpacePoint p;
  p.normal = normal;
  double free = 0.0;
  for (std::size_t a = 0; a < 3; ++a) {
    const double weight = sample.weights[a];
    if (weight == 0.0) continue;
    const detail::HalfSpacePoint& own = vertex(sample.vertices[a]);
    if (!own.is_known() && !own.is_fixed) return {.bending_error = own.bending_error, .is_disturbed = own.is_disturbed};
    if (!own.is_fixed) free += weight;
    p.body = own.body;
    p.position += weight * own.position;
    p.root += weight * own.root;
    p.poisson_ratio += weight * own.poisson_ratio;
    p.length += weight * own.length;
    p.edge_nearness += weight * own.edge_nearness;
    p.bending_error += weight * own.bending_error;
    p.is_disturbed = p.is_disturbed || own.is_disturbed;
  }
  p.is_fixed = p.root == 0.0;
  p.is_disturbed = p.is_disturbed || (free < 1.0 - 1e-9 && !p.is_fixed);
  if (free > 0.0) p.root *= std::min(1.0, free / beside) / free;
  return p;
}

PALPATE_INLINE Matrix3 SubfacetCompliance::half_space(const detail::HalfSpacePoint& p,
                                                      const detail::HalfSpacePoint& q) noexcept {
  return p.is_known() && q.is_known() ? detail::supported_compliance(p, q) : Matrix3::Zero();
}

PALPATE_INLINE Matrix3 SubfacetCompliance::shown(const detail::ContactSample& p,
                                                 const detail::ContactSample& q) const noexcept {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t b = 0; b < 3; ++b) {
    if (q.weights[b] == 0.0) continue;
    for (std::size_t a = 0; a < 3; ++a)
      if (const Block* block = p.weights[a] > 0.0 ? find(p.vertices[a], q.vertices[b]) : nullptr)
        sum.noalias() += (p.weights[a] * q.weights[b]) * block->shown;
  }
  return sum;
}

}}  // namespace palpate
