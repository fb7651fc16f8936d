// Definitions of surface_displacement.hpp.
#pragma once

#include <palpate/contact/detail/surface_displacement.hpp>

#include <algorithm>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE SurfaceDisplacement::SurfaceDisplacement(int vertices, int capacity)
    : forces_(static_cast<std::size_t>(capacity)),
      displacement_(static_cast<std::size_t>(vertices)),
      stamp_(static_cast<std::size_t>(vertices), 0),
      slot_(static_cast<std::size_t>(vertices), -1) {}

PALPATE_INLINE void SurfaceDisplacement::begin_tick(std::uint64_t revision) noexcept {
  if (revision != std::exchange(revision_, revision)) ++generation_;
}

PALPATE_INLINE void SurfaceDisplacement::move_to(SurfaceDisplacement& fresh) noexcept {
  displacement_.swap(fresh.displacement_);
  stamp_.swap(fresh.stamp_);
  slot_.swap(fresh.slot_);
  const auto end = std::remove_if(forces_.begin(), forces_.begin() + count_, [&](const VertexForce& f) {
    return static_cast<std::size_t>(f.vertex) >= displacement_.size();
  });
  count_ = static_cast<int>(end - forces_.begin());
  ++generation_;
}

PALPATE_INLINE void SurfaceDisplacement::add(int vertex, const Vector3& force, int& slot) noexcept {
  if (slot >= 0) {
    forces_[static_cast<std::size_t>(slot)].force += ModelVector(force);
    return;
  }
  slot = count_;
  VertexForce& f = forces_[static_cast<std::size_t>(count_++)];
  f.vertex = vertex;
  f.force = ModelVector(force);
}

PALPATE_INLINE void SurfaceDisplacement::blend(const SurfaceDisplacement& before, double part) noexcept {
  ++generation_;
  for (int i = 0; i < count_; ++i) {
    VertexForce& f = forces_[static_cast<std::size_t>(i)];
    f.force = ModelVector(part * f.force.in_model_axes());
    slot_[static_cast<std::size_t>(f.vertex)] = i;
  }
  for (const VertexForce& f : before.forces()) {
    int& slot = slot_[static_cast<std::size_t>(f.vertex)];
    if (slot >= 0 || count_ < static_cast<int>(forces_.size()))
      add(f.vertex, Vector3((1.0 - part) * f.force.in_model_axes()), slot);
  }
  for (const VertexForce& f : forces()) slot_[static_cast<std::size_t>(f.vertex)] = -1;
}

PALPATE_INLINE Vector3 SurfaceDisplacement::position(const TissueView& tissue, int vertex) noexcept {
  return tissue.contact_surface().position(vertex) + at(tissue, vertex);
}

PALPATE_INLINE double SurfaceDisplacement::deviation(const TissueView& tissue, int vertex) noexcept {
  const ExpectedSurface& expected = tissue.contact_surface().expected();
  if (!expected.is_known()) return at(tissue, vertex).norm();
  return (position(tissue, vertex) - expected.position(vertex)).norm();
}

PALPATE_INLINE double SurfaceDisplacement::reach_from_expected(const TissueView& tissue) noexcept {
  const ExpectedSurface& expected = tissue.contact_surface().expected();
  if (!expected.is_known()) return reach(tissue);
  double loaded = 0.0;
  for (const VertexForce& f : forces()) loaded = std::max(loaded, deviation(tissue, f.vertex));
  for (const int v : expected.loaded()) loaded = std::max(loaded, deviation(tissue, v));
  return 2.0 * loaded;
}

PALPATE_INLINE double SurfaceDisplacement::reach(const TissueView& tissue) noexcept {
  double bounded = 0.0, loaded = 0.0;
  for (const VertexForce& f : forces()) {
    bounded += tissue.compliance_bound(f.vertex) * f.force.in_model_axes().norm();
    loaded = std::max(loaded, at(tissue, f.vertex).norm());
  }
  return std::min(bounded, 2.0 * loaded);
}

}}  // namespace palpate
