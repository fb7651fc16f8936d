// A tissue that wraps another one forwards every hook, and hooks that do nothing are not called.
#include <palpate/concepts/tissue_adaptor.hpp>

#include "contact/analytic_tissue.hpp"

#include "catch.hpp"

using namespace palpate;

namespace {

/// Springs that count the calls of every hook.
struct Counting : test::AnalyticTissue {
  Counting() : AnalyticTissue(4, 0.04, 1e-3) {}
  void prefetch(std::span<const int> vertices) noexcept { prefetched += vertices.size(); }
  Status begin_tick() noexcept {
    ++begun;
    return StatusFlag::slow_tissue;
  }
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points) noexcept {
    pressing = forces.size();
    pressing_points = points.size();
  }
  std::uint64_t updates() const noexcept { return 7; }
  void exchange_contacts(ContactProblem&) noexcept { ++exchanged; }
  void prepare_tools(const ToolRadii& radii, const ContactParameters&) { smallest = radii.smallest; }
  bool try_cut(const BladeSweep&) noexcept { return ++cuts < 2; }
  BackgroundStep background_work() noexcept { return {true, 0.5}; }
  void report_slow(bool is) noexcept { slow = is; }
  void report_failed(bool is) noexcept { failed = is; }

  std::size_t prefetched = 0, pressing = 0, pressing_points = 0;
  int begun = 0, exchanged = 0, cuts = 0;
  double smallest = 0.0;
  bool slow = false, failed = false;
};

/// Changes nothing.
template <class Tissue>
struct Same : TissueAdaptor<Tissue> {
  using TissueAdaptor<Tissue>::TissueAdaptor;
};
/// Changes the tissue before each tick.
struct Announcing : Same<test::AnalyticTissue> {
  using Same::Same;
  Status begin_tick() noexcept { return {}; }
};
/// Changes the compliance and only one of the functions that depend on it.
struct Forgetful : Same<test::AnalyticTissue> {
  using Same::Same;
  Matrix3 compliance(int i, int j) const noexcept { return 2.0 * tissue().compliance(i, j); }
  double compliance_bound(int j) const noexcept { return 2.0 * tissue().compliance_bound(j); }
};
/// The same by derivation from the tissue itself.
struct ForgetfulSprings : test::AnalyticTissue {
  using AnalyticTissue::AnalyticTissue;
  Matrix3 compliance(int i, int j) const noexcept { return 2.0 * AnalyticTissue::compliance(i, j); }
};
/// Inherits the compliance and has a tighter bound for it.
struct Tighter : Same<test::AnalyticTissue> {
  using Same::Same;
  double compliance_bound(int j) const noexcept { return 0.9 * tissue().compliance_bound(j); }
};
/// Scales from a base without compliance belong to the class that has the compliance.
struct Scales {
  std::uint64_t compliance_revision() const noexcept { return 0; }
  double compliance_bound(int) const noexcept { return 1.0; }
  double compliance_floor() const noexcept { return 1e-12; }
};
struct Composed : StillTissue, Scales {
  const ContactSurface& contact_surface() const noexcept { return surface; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int, int) const noexcept { return Matrix3::Identity(); }
  const Eigen::Isometry3d& to_world() const noexcept { return pose; }
  ContactSurface surface;
  Eigen::Isometry3d pose;
};

using Still = test::AnalyticTissue;
static_assert(AnnouncesChanges<Counting> && AnnouncesChanges<Same<Counting>> && AnnouncesChanges<Same<Same<Counting>>>);
static_assert(HasBackgroundWork<Same<Counting>>);
static_assert(TissueModel<Same<Still>> && !AnnouncesChanges<Same<Still>> && !HasBackgroundWork<Same<Still>>);
static_assert(TissueModel<Announcing> && AnnouncesChanges<Announcing>);
static_assert(!TissueModel<Forgetful> && !TissueModel<ForgetfulSprings>);
static_assert(TissueModel<Tighter> && TissueModel<Composed>);
static_assert(std::constructible_from<Same<Still>, Still&> && !std::constructible_from<Same<Still>, Still>);

}  // namespace

TEST_CASE("an adaptor forwards every hook, also through another adaptor", "[contact][tissue]") {
  Counting springs;
  Same<Counting> inner(springs);
  Same<Same<Counting>> outer(inner);
  TissueView view(outer);
  CHECK(&view.contact_surface() == &springs.contact_surface());
  CHECK(view.compliance(3, 3) == springs.compliance(3, 3));

  CHECK(view.prefetches());
  view.prefetch(std::array{1, 2, 3});
  CHECK(springs.prefetched == 3);
  ContactProblem problem(springs.contact_surface(), 5e-3);
  CHECK(view.announces_changes());
  CHECK(view.begin_tick(problem).has(StatusFlag::slow_tissue));
  CHECK(springs.begun == 1);
  CHECK(springs.exchanged == 1);
  view.end_tick(std::array<VertexForce, 2>{}, std::array<PointForce, 1>{});
  CHECK(springs.pressing == 2);
  CHECK(springs.pressing_points == 1);
  CHECK(view.has_updates());
  CHECK(view.updates() == 7);
  view.prepare_tools(4e-3, {});
  CHECK(springs.smallest == 4e-3);
  CHECK(view.can_be_cut());
  CHECK(view.try_cut({}));
  CHECK_FALSE(view.try_cut({}));
  CHECK(outer.background_work().next == 0.5);
  outer.report_slow(true);
  outer.report_failed(true);
  CHECK(springs.slow);
}

TEST_CASE("the hooks of a tissue that does not move are not called", "[contact][tissue]") {
  test::AnalyticTissue springs(4, 0.04, 1e-3);
  Same<test::AnalyticTissue> same(springs);
  TissueView view(same);
  CHECK_FALSE(view.prefetches());
  CHECK_FALSE(view.announces_changes());
  CHECK_FALSE(view.has_updates());
  CHECK_FALSE(view.can_be_cut());
  CHECK_FALSE(view.try_cut({}));
  Announcing announcing(springs);
  CHECK(TissueView(announcing).announces_changes());
}
