// A tissue that touches others, for the thread that solves their contact.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/tissue_view.hpp>

#include <concepts>
#include <cstddef>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A tissue that moves and can be touched by others: the thread that steps it can read the surface without any forces
/// and the compliance, and set the forces of the other tissues.
template <class T>
concept MovesBesideOthers = AnnouncesChanges<T> && HasBackgroundWork<T> &&
    requires(T& tissue, const T& constant, std::span<const VertexForce> forces) {
  { constant.newest_surface() }
  noexcept->std::same_as<const ContactSurface&>;
  { constant.newest_compliance(0, 0) }
  noexcept->FixedExpression<3, 3>;
  tissue.set_contact_forces(forces);
} && !OutOfDate<decltype(&T::compliance), decltype(&T::newest_compliance)>;

struct MotionFunctions {
  Status (*begin_tick)(void*) noexcept;
  BackgroundStep (*step)(void*);
  const ContactSurface& (*newest_surface)(const void*) noexcept;
  Matrix3 (*newest_compliance)(const void*, int, int) noexcept;
  void (*set_contact_forces)(void*, std::span<const VertexForce>);
};

template <MovesBesideOthers T>
struct MotionCalls {
  static constexpr MotionFunctions functions{
      [](void* t) noexcept -> Status { return static_cast<T*>(t)->begin_tick(); },
      [](void* t) -> BackgroundStep { return static_cast<T*>(t)->background_work(); },
      [](const void* t) noexcept -> const ContactSurface& { return static_cast<const T*>(t)->newest_surface(); },
      [](const void* t, int i, int j) noexcept -> Matrix3 { return static_cast<const T*>(t)->newest_compliance(i, j); },
      [](void* t, std::span<const VertexForce> f) { static_cast<T*>(t)->set_contact_forces(f); }};
};

/// The compliance as the thread that solves the contact has it: of a static tissue, or of one that moves.
template <class T>
Matrix3 interface_compliance(const T& tissue, int i, int j) noexcept {
  if constexpr (MovesBesideOthers<T>)
    return tissue.newest_compliance(i, j);
  else
    return tissue.compliance(i, j);
}

/// C_ij of all vertices i as three columns of 3 entries per vertex.
template <class T>
void interface_column(const void* t, int j, std::span<double> column) noexcept {
  const T& tissue = *static_cast<const T*>(t);
  const std::size_t n = column.size() / 3;
  double* const c = column.data();
  for (std::size_t i = 0; 3 * i < n; ++i) {
    const Matrix3 block = interface_compliance(tissue, static_cast<int>(i), j);
    for (std::size_t b = 0; b < 3; ++b)
      for (std::size_t a = 0; a < 3; ++a) c[b * n + 3 * i + a] = block.data()[3 * b + a];
  }
}

/// Of a static tissue all threads read the same; of one that moves, each its own copy.
class InterfaceTissue {
 public:
  template <class T>
  explicit InterfaceTissue(T& tissue) noexcept : view_(tissue), tissue_(&tissue), column_(&interface_column<T>) {
    if constexpr (MovesBesideOthers<T>) motion_ = &MotionCalls<T>::functions;
  }

  /// As ticks see it.
  TissueView& view() noexcept { return view_; }
  const TissueView& view() const noexcept { return view_; }
  bool moves() const noexcept { return motion_ != nullptr; }
  /// Whether its surface and compliance are known to the thread that solves the contact.
  bool can_touch_others() const noexcept {
    return !view_.can_be_cut() && (moves() || (!view_.announces_changes() && !view_.takes_forces()));
  }
  /// For the thread that ticks.
  Status begin_tick() noexcept {
    if (!moves()) return {};
    const Status status = motion_->begin_tick(tissue_);
    view_.look();
    return status;
  }

  // For the thread that steps and solves the contact

  BackgroundStep step() { return motion_->step(tissue_); }
  const ContactSurface& surface() const noexcept {
    return moves() ? motion_->newest_surface(tissue_) : view_.contact_surface();
  }
  Matrix3 compliance(int i, int j) const noexcept {
    return moves() ? motion_->newest_compliance(tissue_, i, j) : view_.compliance(i, j);
  }
  /// `column` has 9 entries per vertex.
  void column(int j, std::span<double> column) const noexcept { column_(tissue_, j, column); }
  Vector3 displacement(int i, std::span<const VertexForce> forces) const noexcept {
    Vector3 u(0.0, 0.0, 0.0);
    if (!moves()) {
      view_.displacement(i, forces, u);
      return u;
    }
    for (const VertexForce& f : forces) u += compliance(i, f.vertex) * f.force.in_model_axes();
    return u;
  }
  void set_contact_forces(std::span<const VertexForce> forces) {
    if (moves()) motion_->set_contact_forces(tissue_, forces);
  }

 private:
  TissueView view_;
  void* tissue_;
  void (*column_)(const void*, int, std::span<double>) noexcept;
  const MotionFunctions* motion_ = nullptr;
};

}}}  // namespace palpate::detail
