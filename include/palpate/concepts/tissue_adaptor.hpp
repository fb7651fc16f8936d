// Base classes that give a tissue its hooks: of one that does not move by itself, and of one that wraps another.
#pragma once

#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/concepts/tissue_model.hpp>

#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Base class of a tissue that does not move, compute in the background or get cut: it has every hook of TissueModel,
/// and none of them does anything. A derived class hides the hooks that it implements. Not for a class that wraps
/// another tissue, whose hooks would be lost: use TissueAdaptor for that.
struct StillTissue {
  NoHook prefetch(std::span<const int>) noexcept { return {}; }
  NoHook begin_tick() noexcept { return {}; }
  NoHook end_tick(std::span<const VertexForce>, std::span<const PointForce>) noexcept { return {}; }
  NoHook updates() const noexcept { return {}; }
  NoHook exchange_contacts(ContactProblem&) noexcept { return {}; }
  NoHook prepare_tools(const ToolRadii&, const ContactParameters&) noexcept { return {}; }
  NoHook try_cut(const BladeSweep&) noexcept { return {}; }
  NoHook half_space_map(int) const noexcept { return {}; }
  NoHook background_work() noexcept { return {}; }
  NoHook report_slow(bool) noexcept { return {}; }
  NoHook report_failed(bool) noexcept { return {}; }
};

/// Base class of a tissue that modifies another one. It forwards every function and hook of TissueModel to that tissue;
/// a derived class hides the functions that it changes and calls `tissue()` for the rest. A class that hides
/// `compliance` must also define compliance_revision, compliance_bound and compliance_floor; otherwise it is not a
/// TissueModel. Refers to the wrapped tissue, which must outlive it.
template <TissueModel Tissue>
class TissueAdaptor {
 public:
  static constexpr bool wraps_changed_compliance = detail::HasOutOfDateMaterials<Tissue>;

  explicit TissueAdaptor(Tissue& tissue) noexcept : tissue_(&tissue) {}
  explicit TissueAdaptor(Tissue&&) = delete;

  decltype(auto) contact_surface() const noexcept { return tissue().contact_surface(); }
  Status require_columns(std::span<const int> vertices) noexcept { return tissue_->require_columns(vertices); }
  const Eigen::Isometry3d& to_world() const noexcept { return tissue().to_world(); }
  decltype(auto) compliance(int i, int j) const noexcept { return tissue().compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return tissue().compliance_revision(); }
  double compliance_bound(int j) const noexcept { return tissue().compliance_bound(j); }
  double compliance_floor() const noexcept { return tissue().compliance_floor(); }
  Vector3 displacement_of(int i, std::span<const VertexForce> forces) const noexcept
      requires detail::HasOwnDisplacement<Tissue> {
    return tissue().displacement_of(i, forces);
  }

  auto prefetch(std::span<const int> vertices) noexcept { return tissue_->prefetch(vertices); }
  auto begin_tick() noexcept { return tissue_->begin_tick(); }
  auto end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points) noexcept {
    return tissue_->end_tick(forces, points);
  }
  auto updates() const noexcept { return tissue().updates(); }
  auto exchange_contacts(ContactProblem& problem) noexcept { return tissue_->exchange_contacts(problem); }
  auto prepare_tools(const ToolRadii& radii, const ContactParameters& parameters) {
    return tissue_->prepare_tools(radii, parameters);
  }
  auto try_cut(const BladeSweep& sweep) noexcept { return tissue_->try_cut(sweep); }
  auto half_space_map(int v) const noexcept { return tissue().half_space_map(v); }
  auto background_work() { return tissue_->background_work(); }
  auto report_slow(bool slow) noexcept { return tissue_->report_slow(slow); }
  auto report_failed(bool failed) noexcept { return tissue_->report_failed(failed); }

  TissueClaim& claim() noexcept requires requires(Tissue& t) { t.claim(); }
  { return tissue_->claim(); }
  std::vector<std::string> notes() const requires requires(const Tissue& t) { t.notes(); }
  { return tissue().notes(); }
  bool refuses_suspicious_units() const noexcept requires requires(const Tissue& t) { t.refuses_suspicious_units(); }
  { return tissue().refuses_suspicious_units(); }
  bool can_be_cut() const noexcept requires requires(const Tissue& t) { t.can_be_cut(); }
  { return tissue().can_be_cut(); }
  bool gains_pieces() const noexcept requires requires(const Tissue& t) { t.gains_pieces(); }
  { return tissue().gains_pieces(); }

 protected:
  Tissue& tissue() noexcept { return *tissue_; }
  const Tissue& tissue() const noexcept { return *tissue_; }

 private:
  Tissue* tissue_;
};

}}  // namespace palpate
