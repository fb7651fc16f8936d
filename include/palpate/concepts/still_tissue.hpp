// The hooks of a tissue that does not move by itself.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Base of a tissue that does not move, work or get cut by itself: every hook of TissueModel, none does anything. A
/// class that derives from it hides those it has. Not for a class around another tissue, whose hooks would be lost: that
/// is a TissueAdaptor.
struct StillTissue {
  NoHook prefetch(std::span<const int>) noexcept { return {}; }
  NoHook begin_tick() noexcept { return {}; }
  NoHook end_tick(std::span<const VertexForce>) noexcept { return {}; }
  NoHook updates() const noexcept { return {}; }
  NoHook exchange_contacts(ContactProblem&) noexcept { return {}; }
  NoHook prepare_tools(double, const ContactParameters&) noexcept { return {}; }
  NoHook try_cut(const BladeSweep&) noexcept { return {}; }
  NoHook background_work() noexcept { return {}; }
  NoHook report_slow(bool) noexcept { return {}; }
};

}}  // namespace palpate
