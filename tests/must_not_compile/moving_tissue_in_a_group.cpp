// expect: a tissue that moves by itself cannot be in a TissueGroup
#include <palpate/contact/tissue_group.hpp>

using namespace palpate;

/// A tissue that does not move, or, with begin_tick, one that does.
struct Pad : StillTissue {
  const ContactSurface& contact_surface() const noexcept { return surface; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int, int) const noexcept { return Matrix3::Identity(); }
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_bound(int) const noexcept { return 1.0; }
  double compliance_floor() const noexcept { return 1e-12; }
  const Eigen::Isometry3d& to_world() const noexcept { return place; }
#ifndef PALPATE_GOOD_TWIN
  Status begin_tick() noexcept {
    return {};
  }
#endif

  ContactSurface surface;
  Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
};

TissueGroup group_of(Pad& pad) {
  return TissueGroup(pad);
}
