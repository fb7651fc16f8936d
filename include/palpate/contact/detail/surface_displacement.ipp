// Definitions of surface_displacement.hpp.
#pragma once

#include <palpate/contact/detail/contact_kernels.hpp>
#include <palpate/contact/detail/surface_displacement.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE SurfaceDisplacement::SurfaceDisplacement(int vertices, int capacity, int number)
    : forces_(static_cast<std::size_t>(capacity)),
      loads_(static_cast<std::size_t>(capacity)),
      half_space_(capacity, contact_kernels()),
      sample_(static_cast<std::size_t>(capacity), -1),
      shown_(static_cast<std::size_t>(vertices)),
      loaded_(static_cast<std::size_t>(vertices)),
      shown_stamp_(static_cast<std::size_t>(vertices), 0),
      loaded_stamp_(static_cast<std::size_t>(vertices), 0),
      displacement_(static_cast<std::size_t>(vertices)),
      dented_(static_cast<std::size_t>(vertices)),
      stamp_(static_cast<std::size_t>(vertices), 0),
      dented_stamp_(static_cast<std::size_t>(vertices), 0),
      slot_(static_cast<std::size_t>(vertices), -1),
      generation_(2 + static_cast<std::uint64_t>(number)) {}

PALPATE_INLINE void SurfaceDisplacement::begin_tick(std::uint64_t revision) noexcept {
  if (revision != std::exchange(revision_, revision)) forget();
}

PALPATE_INLINE void SurfaceDisplacement::move_to(SurfaceDisplacement& fresh) noexcept {
  displacement_.swap(fresh.displacement_);
  stamp_.swap(fresh.stamp_);
  dented_.swap(fresh.dented_);
  dented_stamp_.swap(fresh.dented_stamp_);
  slot_.swap(fresh.slot_);
  shown_.swap(fresh.shown_);
  loaded_.swap(fresh.loaded_);
  shown_stamp_.swap(fresh.shown_stamp_);
  loaded_stamp_.swap(fresh.loaded_stamp_);
  const auto end = std::remove_if(forces_.begin(), forces_.begin() + count_, [&](const VertexForce& f) {
    return static_cast<std::size_t>(f.vertex) >= displacement_.size();
  });
  count_ = static_cast<int>(end - forces_.begin());
  change_loads();
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

PALPATE_INLINE void SurfaceDisplacement::add_load(const PointLoad& load, const ContactSample& sample) noexcept {
  if (load_count_ == static_cast<int>(loads_.size())) return;
  half_space_.set(load_count_, load.point, load.force);
  sample_[static_cast<std::size_t>(load_count_)] = load.sample;
  PointLoad& own = loads_[static_cast<std::size_t>(load_count_++)];
  own.sample = load.sample;  // GCC copies the whole struct with `rep movs`, which takes longer than its members
  own.point = load.point;
  own.area = load.area;
  own.moved = load.moved;
  own.force = load.force;
  own.magnitude = load.force.norm();
  for (std::size_t a = 0; a < 3; ++a) {
    if (sample.weights[a] == 0.0) continue;
    const auto v = static_cast<std::size_t>(sample.vertices[a]);
    if (std::exchange(loaded_stamp_[v], load_generation_) != load_generation_) loaded_[v].setZero();
    loaded_[v] += sample.weights[a] * load.force;
  }
}

PALPATE_INLINE void SurfaceDisplacement::compute_shown(const SubfacetCompliance& subfacet, int vertex) noexcept {
  const auto i = static_cast<std::size_t>(vertex);
  shown_stamp_[i] = load_generation_;
  Vector3& u = shown_[i];
  u.setZero();
  const std::span<const int> others = subfacet.vertices_of_blocks(vertex);
  for (std::size_t k = 0; k < others.size(); ++k)
    if (const auto j = static_cast<std::size_t>(others[k]); loaded_stamp_[j] == load_generation_)
      u.noalias() += subfacet.blocks(vertex)[k].shown.transpose() * loaded_[j];
}

inline Vector3 SurfaceDisplacement::of_mesh(const TissueView& tissue, const ContactSample& sample) noexcept {
  Vector3 u = Vector3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    if (sample.weights[a] != 0.0) u += sample.weights[a] * at(tissue, sample.vertices[a]);
  return u;
}

PALPATE_INLINE Vector3 SurfaceDisplacement::of_half_space(const SubfacetCompliance& subfacet,
                                                          const HalfSpacePoint& point, int number) noexcept {
  Vector3 u = Vector3::Zero();
  half_space_.add_displacement(load_count_, point, u);
  const bool by_place = number < 0 || subfacet.has_copies();
  for (std::size_t i = 0; i < static_cast<std::size_t>(load_count_); ++i)
    if (sample_[i] == number || (by_place && is_same_place(point, loads_[i].point)))
      u.noalias() += half_space_self_compliance(point, loads_[i].area) * loads_[i].force;
  return u;
}

PALPATE_INLINE Vector3 SurfaceDisplacement::at_point(const TissueView& tissue, const SubfacetCompliance& subfacet,
                                                     const ContactSample& sample, const HalfSpacePoint& point,
                                                     int number) noexcept {
  const Vector3 u = without_half_space(tissue, subfacet, sample);
  if (load_count_ == 0) return u;
  const Vector3 added = of_half_space(subfacet, point, number);
  return tissue.has_half_space_map() ? Vector3(u + tissue.half_space_map_at(sample) * added) : Vector3(u + added);
}

PALPATE_INLINE Vector3 SurfaceDisplacement::without_half_space(const TissueView& tissue,
                                                               const SubfacetCompliance& subfacet,
                                                               const ContactSample& sample) noexcept {
  const Vector3 mesh = of_mesh(tissue, sample);
  if (load_count_ == 0) return mesh;
  Vector3 added = Vector3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    if (sample.weights[a] != 0.0) added -= sample.weights[a] * shown(subfacet, sample.vertices[a]);
  return tissue.has_half_space_map() ? Vector3(mesh + tissue.half_space_map_at(sample) * added) : Vector3(mesh + added);
}

/// Loads of less than a twentieth of the largest do not count for the directions: points at the rim of a deep print.
PALPATE_INLINE void SurfaceDisplacement::measure_dents(const TissueView& tissue, const SubfacetCompliance& subfacet,
                                                       const ContactSamples& samples) noexcept {
  constexpr double small_part = 0.05;
  if (std::exchange(dent_stamp_, generation_) == generation_) return;
  dent_before_ = largest_dent_;
  pressed_normal_.setZero();
  double dent = 0.0, half_space = 0.0, largest = 0.0;  // the first two squared
  const std::span<const PointLoad> loads(loads_.data(), static_cast<std::size_t>(load_count_));
  for (const PointLoad& load : loads) {
    const ContactSample& sample = samples[load.sample];
    dent = std::max(dent, (load.moved - of_mesh(tissue, sample)).squaredNorm());
    half_space = std::max(half_space, (load.moved - without_half_space(tissue, subfacet, sample)).squaredNorm());
    largest = std::max(largest, load.magnitude);
    pressed_normal_ += load.magnitude * load.point.normal;
  }
  largest_dent_ = std::sqrt(dent);
  largest_half_space_ = std::sqrt(half_space);
  pressed_normal_.normalize();
  only_presses_ = true;
  for (const PointLoad& load : loads)
    if (load.magnitude > small_part * largest)
      only_presses_ = only_presses_ && -load.force.dot(load.point.normal) > aligned * load.magnitude &&
                      load.point.normal.dot(pressed_normal_) > aligned;
}

/// A point that has both loads has their sum. Of loads that were blended again and again, those are left out that are a
/// thousandth of the largest.
PALPATE_INLINE void SurfaceDisplacement::blend_loads(const SurfaceDisplacement& before, double part,
                                                     const ContactSamples& samples) noexcept {
  constexpr double negligible = 1e-3;
  const auto count = static_cast<std::size_t>(load_count_);
  double largest = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    loads_[i].force *= part;
    loads_[i].moved *= part;
    largest = std::max(largest, loads_[i].force.norm());
  }
  for (std::size_t i = 0; i < static_cast<std::size_t>(before.load_count_); ++i)
    largest = std::max(largest, (1.0 - part) * before.loads_[i].force.norm());
  for (std::size_t i = 0; i < static_cast<std::size_t>(before.load_count_); ++i) {
    PointLoad load = before.loads_[i];
    load.force *= 1.0 - part;
    load.moved *= 1.0 - part;
    const auto same = std::find_if(loads_.begin(), loads_.begin() + static_cast<std::ptrdiff_t>(count),
                                   [&](const PointLoad& own) { return own.sample == load.sample; });
    if (same != loads_.begin() + static_cast<std::ptrdiff_t>(count))
      same->force += load.force, same->moved += load.moved;
    else if (load.force.norm() > negligible * largest && load_count_ < static_cast<int>(loads_.size()))
      loads_[static_cast<std::size_t>(load_count_++)] = load;
  }
  const int all = std::exchange(load_count_, 0);
  for (int i = 0; i < all; ++i) {
    const PointLoad load = loads_[static_cast<std::size_t>(i)];
    add_load(load, samples[load.sample]);
  }
}

/// The dents of both are linear in their forces: their blended sum is a bound for the largest.
PALPATE_INLINE void SurfaceDisplacement::blend(const TissueView& tissue, SurfaceDisplacement& before, double part,
                                               const SubfacetCompliance* subfacet,
                                               const ContactSamples& samples) noexcept {
  if (subfacet != nullptr) {
    measure_dents(tissue, *subfacet, samples);
    before.measure_dents(tissue, *subfacet, samples);
    largest_dent_ = part * largest_dent_ + (1.0 - part) * before.largest_dent_;
    largest_half_space_ = part * largest_half_space_ + (1.0 - part) * before.largest_half_space_;
    only_presses_ = only_presses_ && before.only_presses_ && pressed_normal_.dot(before.pressed_normal_) > aligned;
  }
  change_loads();
  dent_stamp_ = generation_;
  blend_loads(before, part, samples);
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

PALPATE_INLINE Vector3 SurfaceDisplacement::dented_position(const TissueView& tissue,
                                                            const SubfacetCompliance* subfacet, int vertex) noexcept {
  if (subfacet == nullptr || load_count_ == 0 || !subfacet->is_known(vertex)) return position(tissue, vertex);
  const auto i = static_cast<std::size_t>(vertex);
  if (std::exchange(dented_stamp_[i], generation_) != generation_) {
    const ContactSample sample{{vertex, vertex, vertex}, {1.0, 0.0, 0.0}};
    dented_[i] = at_point(tissue, *subfacet, sample, subfacet->vertex(vertex), -1);
  }
  return tissue.contact_surface().position(vertex) + dented_[i];
}

PALPATE_INLINE double SurfaceDisplacement::deviation(const TissueView& tissue, int vertex) noexcept {
  const ExpectedSurface& expected = tissue.contact_surface().expected();
  if (!expected.is_known()) return at(tissue, vertex).norm();
  return (position(tissue, vertex) - expected.position(vertex)).norm();
}

/// The half-space moves loaded points farther than others. Under them it may be stiffer, since the surface is stretched
/// there: hence the factor. Right after a step the stored displacements of loaded points belong to the surface before
/// the step, so the dent of that surface counts, too.
PALPATE_INLINE double SurfaceDisplacement::reach_from_expected(const TissueView& tissue,
                                                               const SubfacetCompliance* subfacet,
                                                               const ContactSamples& samples) noexcept {
  constexpr double stretched = 1.5;
  const ExpectedSurface& expected = tissue.contact_surface().expected();
  if (!expected.is_known()) return reach(tissue);
  double loaded = 0.0;
  for (const VertexForce& f : forces()) loaded = std::max(loaded, deviation(tissue, f.vertex));
  for (const int v : expected.loaded()) loaded = std::max(loaded, deviation(tissue, v));
  if (subfacet == nullptr || load_count_ == 0) return 2.0 * loaded;
  measure_dents(tissue, *subfacet, samples);
  return 2.0 * loaded + stretched * std::max(largest_dent_, dent_before_);
}

PALPATE_INLINE double SurfaceDisplacement::longest_path() const noexcept {
  double longest = 0.0;
  for (int i = 0; i < load_count_; ++i) longest = std::max(longest, loads_[static_cast<std::size_t>(i)].moved.norm());
  return longest;
}

PALPATE_INLINE double SurfaceDisplacement::reach(const TissueView& tissue) noexcept {
  double bounded = 0.0, loaded = 0.0;
  for (const VertexForce& f : forces()) {
    bounded += tissue.compliance_bound(f.vertex) * f.force.in_model_axes().norm();
    loaded = std::max(loaded, at(tissue, f.vertex).norm());
  }
  return std::max(std::min(bounded, 2.0 * loaded), longest_path());
}

}}}  // namespace palpate::detail
