// The laws of a tissue that is another one in a different form: an adaptor that changes nothing.
#pragma once

#include <palpate/contact/tissue_view.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/testing/violation.hpp>

#include <algorithm>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

namespace detail {

/// All that a servo gives in a tick of its first tool.
struct TickResult {
  Vector3 force, torque, contact_force, proxy;
  double indentation = 0.0;
  int contacts = 0;
  Status status;
  ForceError error;
};

inline bool same(const Vector3& a, const Vector3& b) noexcept {
  return a[0] == b[0] && a[1] == b[1] && a[2] == b[2];
}
inline bool same(const ForceError& a, const ForceError& b) noexcept {
  return a.expected == b.expected && a.bound == b.bound && a.force == b.force && a.parts.values() == b.parts.values();
}

/// Of a tissue or a TissueGroup. Background work of a tissue is done after every tick.
template <class T>
std::vector<TickResult> run_session(T& tissue, const ToolList& tools, std::span<const ToolState> path,
                                    const ServoOptions& options) {
  HapticServo servo(tissue, tools, options);
  std::vector<TickResult> results;
  for (const ToolState& state : path) {
    const GatedForce& force = servo.tick(state);
    const TickView view = servo.tick_view();
    results.push_back({force.force(), force.torque(), view.contact_force(), view.proxy(), view.indentation(),
                       view.contact_rows(), force.status, view.force_error()});
    if constexpr (HasBackgroundWork<T>) tissue.background_work();
  }
  servo.release();
  return results;
}

inline bool same_surface(const ContactSurface& a, const ContactSurface& b) {
  const auto equal = [](std::span<const Vector3> x, std::span<const Vector3> y) {
    return std::equal(x.begin(), x.end(), y.begin(), y.end(), [](const auto& p, const auto& q) { return same(p, q); });
  };
  return a.triangles() == b.triangles() && std::ranges::equal(a.shell(), b.shell()) &&
         equal(a.positions(), b.positions()) && equal(a.shell_positions(), b.shell_positions());
}

}  // namespace detail

/// Laws of `same`, which is `tissue` in another form: a class derived from TissueAdaptor that changes nothing. All of
/// them hold to the last bit: "same surface", "same pose", "same scales" of the compliance, "same hooks", and of a
/// session that follows the path: "same force" with proxy and torque, "same status", "same error" of the force, "same
/// contacts". State k is that of the first tool in tick k; further tools stay in the air.
/// For a tissue that moves or is cut, `same` must be another form of a second tissue in the same state; its background
/// work is done after every tick. Cost: two servos and two sessions of the length of the path.
template <TissueModel T, TissueModel Same>
Violations same_tissue_laws(T& tissue, Same& same, const ToolList& tools, std::span<const ToolState> path,
                            const ServoOptions& options = {}) {
  Violations v;
  const TissueView view(tissue), other(same);
  expect_true(v, "same surface", detail::same_surface(view.contact_surface(), other.contact_surface()));
  expect_true(v, "same pose", view.to_world().matrix() == other.to_world().matrix());
  if (!v.empty()) return v;
  bool scales = view.compliance_floor() == other.compliance_floor();
  for (int i = 0; i < view.contact_surface().vertex_count(); ++i)
    scales = scales && view.compliance_bound(i) == other.compliance_bound(i);
  expect_true(v, "same scales", scales);
  expect_true(v, "same hooks",
              view.announces_changes() == other.announces_changes() && view.has_updates() == other.has_updates() &&
                  view.can_be_cut() == other.can_be_cut() && view.gains_pieces() == other.gains_pieces() &&
                  HasBackgroundWork<T> == HasBackgroundWork<Same>);
  const auto expected = detail::run_session(tissue, tools, path, options);
  const auto got = detail::run_session(same, tools, path, options);
  const auto differs = [&](auto equal) {
    std::size_t k = 0;
    while (k < path.size() && equal(expected[k], got[k])) ++k;
    return k;
  };
  const auto expect_same = [&](std::string_view law, auto equal) {
    const std::size_t tick = differs(equal);
    expect_true(v, law, tick == path.size(), "tick " + std::to_string(tick));
  };
  using Result = detail::TickResult;
  expect_same("same force", [](const Result& a, const Result& b) {
    return detail::same(a.force, b.force) && detail::same(a.torque, b.torque) &&
           detail::same(a.contact_force, b.contact_force) && detail::same(a.proxy, b.proxy);
  });
  expect_same("same status", [](const Result& a, const Result& b) { return a.status == b.status; });
  expect_same("same error", [](const Result& a, const Result& b) { return detail::same(a.error, b.error); });
  expect_same("same contacts", [](const Result& a, const Result& b) {
    return a.contacts == b.contacts && a.indentation == b.indentation;
  });
  return v;
}

}}}  // namespace palpate::testing
