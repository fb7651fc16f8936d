// Base class with empty hooks for a tissue that does not move by itself.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

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

}}  // namespace palpate
