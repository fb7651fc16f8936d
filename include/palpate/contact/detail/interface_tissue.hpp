// A tissue that touches others, for the thread that solves their contact.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/tissue_view.hpp>
#include <palpate/core/types.hpp>

#include <concepts>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A tissue that moves or is cut and can be touched by others: the thread that does its background work can read the
/// surface without any forces, the number of changes of its triangles, a contact problem for a session to continue with
/// after such a change, and the compliance, and set the forces of the other tissues.
template <class T>
concept ChangesBesideOthers = AnnouncesChanges<T> && HasBackgroundWork<T> &&
    requires(T& tissue, const T& constant, std::span<const VertexForce> forces) {
  { constant.newest_surface() }
  noexcept->std::same_as<const ContactSurface&>;
  { constant.newest_surface_number() }
  noexcept->std::same_as<std::uint64_t>;
  { constant.newest_contact() }
  noexcept->std::same_as<std::shared_ptr<ContactProblem>>;
  { constant.newest_compliance(0, 0) }
  noexcept->FixedExpression<3, 3>;
  tissue.set_contact_forces(forces);
} && !OutOfDate<decltype(&T::compliance), decltype(&T::newest_compliance)>;

/// One whose surface and compliance are others after every step.
template <class T>
concept MovesBesideOthers = ChangesBesideOthers<T> && requires(const T& constant) {
  constant.steps();
};

/// One of rigid parts that touch each other and the other tissues, to which the pieces of tissues that are cut belong.
template <class T>
concept HasParts = MovesBesideOthers<T> && requires(T& tissue, const T& constant, const void* other) {
  { constant.newest_parts() }
  noexcept->std::same_as<std::span<const Index>>;
  { constant.takes_from(other) } -> std::same_as<bool>;
  tissue.take_pieces(other);
};

struct ChangeFunctions {
  Status (*begin_tick)(void*) noexcept;
  BackgroundStep (*work)(void*);
  const ContactSurface& (*newest_surface)(const void*) noexcept;
  std::uint64_t (*newest_surface_number)(const void*) noexcept;
  std::shared_ptr<ContactProblem> (*newest_contact)(const void*) noexcept;
  Matrix3 (*newest_compliance)(const void*, int, int) noexcept;
  void (*set_contact_forces)(void*, std::span<const VertexForce>);
  bool moves;
  Status (*order_status)(void*) noexcept = nullptr;  ///< null, as the next: it cannot be cut
  bool (*has_orders)(const void*) noexcept = nullptr;
  std::span<const Index> (*parts)(const void*) noexcept = nullptr;  ///< null, as the next: it is one body
  void (*take_pieces)(void*, const void*) = nullptr;
  bool (*takes_from)(const void*, const void*) = nullptr;
};

template <ChangesBesideOthers T>
struct ChangeCalls {
  static constexpr ChangeFunctions table() noexcept {
    ChangeFunctions f{
        [](void* t) noexcept -> Status { return static_cast<T*>(t)->begin_tick(); },
        [](void* t) -> BackgroundStep { return static_cast<T*>(t)->background_work(); },
        [](const void* t) noexcept -> const ContactSurface& { return static_cast<const T*>(t)->newest_surface(); },
        [](const void* t) noexcept { return static_cast<const T*>(t)->newest_surface_number(); },
        [](const void* t) noexcept { return static_cast<const T*>(t)->newest_contact(); },
        [](const void* t, int i, int j) noexcept -> Matrix3 {
          return static_cast<const T*>(t)->newest_compliance(i, j);
        },
        [](void* t, std::span<const VertexForce> forces) { static_cast<T*>(t)->set_contact_forces(forces); },
        MovesBesideOthers<T>};
    if constexpr (requires(T & t) { t.order_status(); }) {
      f.order_status = [](void* t) noexcept -> Status { return static_cast<T*>(t)->order_status(); };
      f.has_orders = [](const void* t) noexcept -> bool { return static_cast<const T*>(t)->has_orders(); };
    }
    if constexpr (HasParts<T>) {
      f.parts = [](const void* t) noexcept { return static_cast<const T*>(t)->newest_parts(); };
      f.take_pieces = [](void* t, const void* other) { static_cast<T*>(t)->take_pieces(other); };
      f.takes_from = [](const void* t, const void* other) { return static_cast<const T*>(t)->takes_from(other); };
    }
    return f;
  }
  static constexpr ChangeFunctions functions = table();
};

/// The compliance as the thread that solves the contact has it.
template <class T>
Matrix3 interface_compliance(const T& tissue, int i, int j) noexcept {
  if constexpr (ChangesBesideOthers<T>)
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

/// Of a tissue that neither moves nor is cut, all threads read the same; of another one, each its own copy.
class InterfaceTissue {
 public:
  template <class T>
  explicit InterfaceTissue(T& tissue) noexcept : view_(tissue), tissue_(&tissue), column_(&interface_column<T>) {
    if constexpr (ChangesBesideOthers<T>) changes_ = &ChangeCalls<T>::functions;
  }

  /// As ticks see it.
  TissueView& view() noexcept { return view_; }
  const TissueView& view() const noexcept { return view_; }
  /// Whether it has background work, after which surface and compliance may be others.
  bool changes() const noexcept { return changes_ != nullptr; }
  /// Whether they are others after every piece of work; else only where triangles have changed.
  bool moves() const noexcept { return changes() && changes_->moves; }
  /// Whether its surface and compliance are known to the thread that solves the contact.
  bool can_touch_others() const noexcept {
    return changes() || (!view_.can_be_cut() && !view_.announces_changes() && !view_.takes_forces());
  }

  // For the thread that ticks

  Status begin_tick() noexcept {
    if (!changes()) return {};
    const Status status = changes_->begin_tick(tissue_);
    view_.look();
    return status;
  }
  /// Whether cuts are ordered and not made yet, and whether nobody makes them.
  Status order_status() noexcept {
    return changes() && changes_->order_status != nullptr ? changes_->order_status(tissue_) : Status{};
  }

  // For the thread that does the work and solves the contact

  BackgroundStep work() { return changes_->work(tissue_); }
  /// Whether cuts are ordered and not made yet.
  bool has_orders() const noexcept {
    return changes() && changes_->has_orders != nullptr && changes_->has_orders(tissue_);
  }
  const ContactSurface& surface() const noexcept {
    return changes() ? changes_->newest_surface(tissue_) : view_.contact_surface();
  }
  /// Changes whenever the surface has other triangles; vertices keep their numbers, new ones follow.
  std::uint64_t surface_number() const noexcept { return changes() ? changes_->newest_surface_number(tissue_) : 0; }
  /// Of that surface, made for the tools of the session; null before a cut. A session takes its workspaces.
  std::shared_ptr<ContactProblem> contact() const noexcept {
    return changes() ? changes_->newest_contact(tissue_) : nullptr;
  }
  Matrix3 compliance(int i, int j) const noexcept {
    return changes() ? changes_->newest_compliance(tissue_, i, j) : view_.compliance(i, j);
  }
  /// `column` has 9 entries per vertex.
  void column(int j, std::span<double> column) const noexcept { column_(tissue_, j, column); }
  Vector3 displacement(int i, std::span<const VertexForce> forces) const noexcept {
    Vector3 u(0.0, 0.0, 0.0);
    if (!changes()) {
      view_.displacement(i, forces, u);
      return u;
    }
    for (const VertexForce& f : forces) u += compliance(i, f.vertex) * f.force.in_model_axes();
    return u;
  }
  bool has_parts() const noexcept { return changes() && changes_->parts != nullptr; }
  /// The part of every triangle; empty for one body.
  std::span<const Index> parts() const noexcept {
    return has_parts() ? changes_->parts(tissue_) : std::span<const Index>{};
  }
  /// Whether the pieces of another tissue belong to it.
  bool takes_from(const InterfaceTissue& other) const {
    return has_parts() && changes_->takes_from(tissue_, other.tissue_);
  }
  /// After a cut of another tissue.
  void take_pieces(const InterfaceTissue& other) {
    if (has_parts()) changes_->take_pieces(tissue_, other.tissue_);
  }
  void set_contact_forces(std::span<const VertexForce> forces) {
    if (changes()) changes_->set_contact_forces(tissue_, forces);
  }

 private:
  TissueView view_;
  void* tissue_;
  void (*column_)(const void*, int, std::span<double>) noexcept;
  const ChangeFunctions* changes_ = nullptr;
};

}}}  // namespace palpate::detail
