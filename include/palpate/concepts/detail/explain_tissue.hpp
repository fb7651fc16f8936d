// Compiler messages that name what a type lacks to be a TissueModel.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Does not compile for a type that is not a TissueModel; the message names what is missing.
template <class T>
constexpr void explain_tissue() noexcept {
  static_assert(!std::is_const_v<T>, "palpate: a const tissue cannot be touched: ticks change it");
  if constexpr (!std::is_const_v<T>) {
    static_assert(HasSurface<T>,
                  "palpate: not a tissue: it needs contact_surface() const, require_columns(span<const int>) and "
                  "to_world() const, all noexcept (concepts/tissue_model.hpp)");
    static_assert(HasCompliance<T>,
                  "palpate: this tissue needs compliance(int, int) const noexcept, which returns 3 x 3 doubles");
    static_assert(HasComplianceScales<T>,
                  "palpate: this tissue needs compliance_revision(), compliance_bound(int) and compliance_floor(), "
                  "const noexcept");
    static_assert(!HasOutOfDateScale<T>,
                  "palpate: this tissue changes the compliance that it inherits; it must define compliance_revision(), "
                  "compliance_bound(int) and compliance_floor() as well");
#define PALPATE_HOOK(hook, call)                                                                                   \
  static_assert(hook<T>, "palpate: this tissue has no hook " call                                                   \
                         ": derive it from TissueAdaptor, which forwards the hooks of another tissue, or, if it "   \
                         "does not move, from StillTissue")
    PALPATE_HOOK(HasPrefetch, "prefetch(span<const int>) noexcept -> void or NoHook");
    PALPATE_HOOK(HasBeginTick, "begin_tick() noexcept -> Status or NoHook");
    PALPATE_HOOK(HasEndTick, "end_tick(span<const VertexForce>, span<const PointForce>) noexcept -> void or NoHook");
    PALPATE_HOOK(HasUpdates, "updates() const noexcept -> uint64_t or NoHook");
    PALPATE_HOOK(HasExchangeContacts, "exchange_contacts(ContactProblem&) noexcept -> void or NoHook");
    PALPATE_HOOK(HasPrepareTools, "prepare_tools(const ToolRadii&, const ContactParameters&) -> void or NoHook");
    PALPATE_HOOK(HasTryCut, "try_cut(const BladeSweep&) noexcept -> bool or NoHook");
    PALPATE_HOOK(HasHalfSpaceMap, "half_space_map(int) const noexcept -> Matrix3 or NoHook");
    PALPATE_HOOK(HasWorkHooks,
                 "background_work() -> BackgroundStep or NoHook, report_slow(bool) or report_failed(bool), both "
                 "noexcept -> void or NoHook");
#undef PALPATE_HOOK
  }
}

}}}  // namespace palpate::detail
