// A type-erased reference to a tissue.
#pragma once

#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/contact/detail/servo_blade.hpp>

#include <memory>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Function table of a tissue. Results that a tick needs in a loop are computed by one function, so that the loop is
/// compiled with the tissue type; null: a hook that does nothing.
struct TissueFunctions {
  const ContactSurface& (*contact_surface)(const void*) noexcept;
  const Eigen::Isometry3d& (*to_world)(const void*) noexcept;
  Status (*require_columns)(void*, std::span<const int>) noexcept;
  void (*compliance)(const void*, int, int, double*) noexcept;
  void (*between)(const void*, const ContactSample&, const ContactSample&, double*) noexcept;
  void (*displacement)(const void*, int, std::span<const VertexForce>, Vector3&) noexcept;
  std::uint64_t (*compliance_revision)(const void*) noexcept;
  double (*compliance_bound)(const void*, int) noexcept;
  double (*compliance_floor)(const void*) noexcept;
  void (*prefetch)(void*, std::span<const int>) noexcept;
  Status (*begin_tick)(void*) noexcept;
  void (*end_tick)(void*, std::span<const VertexForce>, std::span<const PointForce>) noexcept;
  std::uint64_t (*updates)(const void*) noexcept;
  void (*exchange_contacts)(void*, ContactProblem&) noexcept;
  void (*prepare_tools)(void*, const ToolRadii&, const ContactParameters&);
  bool (*try_cut)(void*, const BladeSweep&) noexcept;
  void (*half_space_map)(const void*, int, Matrix3&) noexcept;
  bool has_contact_materials;
  TissueClaim* (*claim)(void*) noexcept = nullptr;
  std::vector<std::string> (*notes)(const void*) = nullptr;
  bool (*refuses_units)(const void*) noexcept = nullptr;
  bool (*can_be_cut)(const void*) noexcept = nullptr;  ///< null: wherever there is try_cut
  bool (*gains_pieces)(const void*) noexcept = nullptr;
  /// With try_cut only: code of blades is compiled for a tissue that can be cut.
  std::unique_ptr<ServoBlade> (*make_blade)(const BladeTool&, double stiffness) = nullptr;
};

template <class T>
struct TissueCalls {
  using Block = std::remove_cvref_t<decltype(std::declval<const T&>().compliance(0, 0))>;
  /// Blocks with direct memory access are read in place; other expressions are evaluated once.
  using Read = std::conditional_t<(int{Block::Flags} & Eigen::DirectAccessBit) != 0, const Block&, const Matrix3>;

  static const T& of(const void* tissue) noexcept { return *static_cast<const T*>(tissue); }
  static T& of(void* tissue) noexcept { return *static_cast<T*>(tissue); }

  static const ContactSurface& contact_surface(const void* t) noexcept { return of(t).contact_surface(); }
  static const Eigen::Isometry3d& to_world(const void* t) noexcept { return of(t).to_world(); }
  static Status require_columns(void* t, std::span<const int> v) noexcept { return of(t).require_columns(v); }
  static void compliance(const void* t, int i, int j, double* out) noexcept {
    Read c = of(t).compliance(i, j);
    for (int k = 0; k < 3; ++k, out += 3) {
      out[0] = c.coeff(0, k);
      out[1] = c.coeff(1, k);
      out[2] = c.coeff(2, k);
    }
  }
  static void between(const void* t, const ContactSample& p, const ContactSample& q, double* out) noexcept {
    if (p.weights[0] == 1.0 && q.weights[0] == 1.0) return compliance(t, p.vertices[0], q.vertices[0], out);
    for (int k = 0; k < 9; ++k) out[k] = 0.0;
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) {
        const double weight = p.weights[a] * q.weights[b];
        if (!(weight > 0.0)) continue;
        Read c = of(t).compliance(p.vertices[a], q.vertices[b]);
        for (int k = 0; k < 3; ++k) {
          out[3 * k] += weight * c.coeff(0, k);
          out[3 * k + 1] += weight * c.coeff(1, k);
          out[3 * k + 2] += weight * c.coeff(2, k);
        }
      }
  }
  /// With Eigen's product: it writes in packets as large as those that the caller reads.
  static void displacement(const void* t, int vertex, std::span<const VertexForce> forces, Vector3& out) noexcept {
    if constexpr (HasOwnDisplacement<T>) {
      out = of(t).displacement_of(vertex, forces);
      return;
    }
    Vector3 u(0.0, 0.0, 0.0);
    for (const VertexForce& f : forces) {
      Read c = of(t).compliance(vertex, f.vertex);
      u.noalias() += c * f.force.in_model_axes();
    }
    out = u;
  }
  static std::uint64_t compliance_revision(const void* t) noexcept { return of(t).compliance_revision(); }
  static double compliance_bound(const void* t, int j) noexcept { return of(t).compliance_bound(j); }
  static double compliance_floor(const void* t) noexcept { return of(t).compliance_floor(); }

  static T& hooked() noexcept;  // in decltype only
  template <class Result>
  static constexpr bool calls = !std::same_as<Result, NoHook>;

  static constexpr TissueFunctions table() noexcept {
    TissueFunctions f{contact_surface,
                      to_world,
                      require_columns,
                      compliance,
                      between,
                      displacement,
                      compliance_revision,
                      compliance_bound,
                      compliance_floor,
                      nullptr,
                      nullptr,
                      nullptr,
                      nullptr,
                      nullptr,
                      nullptr,
                      nullptr,
                      nullptr,
                      !HasOutOfDateMaterials<T>};
    if constexpr (calls<decltype(hooked().prefetch(std::span<const int>{}))>)
      f.prefetch = [](void* t, std::span<const int> v) noexcept { of(t).prefetch(v); };
    if constexpr (AnnouncesChanges<T>) f.begin_tick = [](void* t) noexcept -> Status { return of(t).begin_tick(); };
    if constexpr (calls<decltype(hooked().end_tick(std::span<const VertexForce>{}, std::span<const PointForce>{}))>)
      f.end_tick = [](void* t, std::span<const VertexForce> v, std::span<const PointForce> p) noexcept {
        of(t).end_tick(v, p);
      };
    if constexpr (calls<decltype(hooked().updates())>)
      f.updates = [](const void* t) noexcept -> std::uint64_t { return of(t).updates(); };
    if constexpr (calls<decltype(hooked().exchange_contacts(std::declval<ContactProblem&>()))>)
      f.exchange_contacts = [](void* t, ContactProblem& p) noexcept { of(t).exchange_contacts(p); };
    if constexpr (calls<decltype(hooked().prepare_tools(std::declval<const ToolRadii&>(),
                                                        std::declval<const ContactParameters&>()))>)
      f.prepare_tools = [](void* t, const ToolRadii& radii, const ContactParameters& p) {
        of(t).prepare_tools(radii, p);
      };
    if constexpr (calls<decltype(hooked().try_cut(std::declval<const BladeSweep&>()))>) {
      f.try_cut = [](void* t, const BladeSweep& s) noexcept -> bool { return of(t).try_cut(s); };
      f.make_blade = &make_blade;
    }
    if constexpr (requires(const T& t) { t.can_be_cut(); })
      f.can_be_cut = [](const void* t) noexcept -> bool { return of(t).can_be_cut(); };
    if constexpr (requires(const T& t) { t.gains_pieces(); })
      f.gains_pieces = [](const void* t) noexcept -> bool { return of(t).gains_pieces(); };
    if constexpr (calls<decltype(hooked().half_space_map(0))>)
      f.half_space_map = [](const void* t, int v, Matrix3& r) noexcept { r = of(t).half_space_map(v); };
    if constexpr (requires(T & t) { t.claim(); })
      f.claim = [](void* t) noexcept -> TissueClaim* { return &of(t).claim(); };
    if constexpr (requires(const T& t) { t.notes(); })
      f.notes = [](const void* t) -> std::vector<std::string> { return of(t).notes(); };
    if constexpr (requires(const T& t) { t.refuses_suspicious_units(); })
      f.refuses_units = [](const void* t) noexcept -> bool { return of(t).refuses_suspicious_units(); };
    return f;
  }
  static constexpr TissueFunctions functions = table();
};

}  // namespace detail

/// A reference to any TissueModel: a pointer to it, a pointer to the table of its functions, and a third pointer to its
/// surface, which is requested once: call `look` again when the tissue may have another surface. The tissue must
/// outlive it. The functions are those of TissueModel and cost a call through a pointer; hooks that do nothing cost no
/// call. Does not compile for another type: the message states what it lacks.
class TissueView {
 public:
  template <class T>
  requires(!std::same_as<std::remove_cv_t<T>, TissueView>) TissueView(T& tissue)
  noexcept  // NOLINT(google-explicit-constructor)
      : tissue_(&tissue), functions_(functions_of<T>()) {
    look();
  }

  bool is_same(const TissueView& other) const noexcept { return tissue_ == other.tissue_; }
  /// Updates the pointer to the surface.
  void look() noexcept { surface_ = &functions_->contact_surface(tissue_); }
  const ContactSurface& contact_surface() const noexcept { return *surface_; }
  const Eigen::Isometry3d& to_world() const noexcept { return functions_->to_world(tissue_); }

  Status require_columns(std::span<const int> vertices) const noexcept {
    return functions_->require_columns(tissue_, vertices);
  }
  Matrix3 compliance(int i, int j) const noexcept {
    Matrix3 block;
    functions_->compliance(tissue_, i, j, block.data());
    return block;
  }
  /// J_p C J_q^T: displacement of a point per force on another [m/N].
  void between(const detail::ContactSample& p, const detail::ContactSample& q, Matrix3& block) const noexcept {
    functions_->between(tissue_, p, q, block.data());
  }
  /// Displacement of a vertex under forces on vertices [m].
  void displacement(int vertex, std::span<const VertexForce> forces, Vector3& u) const noexcept {
    functions_->displacement(tissue_, vertex, forces, u);
  }
  std::uint64_t compliance_revision() const noexcept { return functions_->compliance_revision(tissue_); }
  double compliance_bound(int j) const noexcept { return functions_->compliance_bound(tissue_, j); }
  double compliance_floor() const noexcept { return functions_->compliance_floor(tissue_); }

  bool prefetches() const noexcept { return functions_->prefetch != nullptr; }
  void prefetch(std::span<const int> vertices) const noexcept {
    if (prefetches()) functions_->prefetch(tissue_, vertices);
  }
  /// Whether the tissue moves by itself.
  bool announces_changes() const noexcept { return functions_->begin_tick != nullptr; }
  /// `begin_tick` and, for a session with this contact problem, `exchange_contacts`; then `look`.
  Status begin_tick(ContactProblem& problem) noexcept {
    const Status status = announces_changes() ? functions_->begin_tick(tissue_) : Status{};
    if (functions_->exchange_contacts != nullptr) functions_->exchange_contacts(tissue_, problem);
    look();
    return status;
  }
  bool takes_forces() const noexcept { return functions_->end_tick != nullptr; }
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points) const noexcept {
    if (takes_forces()) functions_->end_tick(tissue_, forces, points);
  }
  bool has_updates() const noexcept { return functions_->updates != nullptr; }
  std::uint64_t updates() const noexcept { return has_updates() ? functions_->updates(tissue_) : 0; }
  /// For the tools of a session that begins. Throws what the tissue's hook throws.
  void prepare_tools(const ToolRadii& radii, const ContactParameters& parameters) {
    if (functions_->prepare_tools == nullptr) return;
    functions_->prepare_tools(tissue_, radii, parameters);
    look();
  }

  /// Whether the surface moves relative to its SubfacetCompliance, so that it has maps.
  bool has_half_space_map() const noexcept { return functions_->half_space_map != nullptr; }
  Matrix3 half_space_map(int v) const noexcept {
    Matrix3 r;
    if (!has_half_space_map()) return Matrix3::Identity();
    functions_->half_space_map(tissue_, v, r);
    return r;
  }
  /// The mean of those of a point's vertices.
  Matrix3 half_space_map_at(const detail::ContactSample& point) const noexcept;

  /// Null for a tissue that several servos may use.
  TissueClaim* claim() const noexcept { return functions_->claim != nullptr ? functions_->claim(tissue_) : nullptr; }
  /// What the set-up of the tissue reports, one sentence each. Allocates.
  std::vector<std::string> notes() const {
    return functions_->notes != nullptr ? functions_->notes(tissue_) : std::vector<std::string>{};
  }
  bool refuses_suspicious_units() const noexcept {
    return functions_->refuses_units != nullptr && functions_->refuses_units(tissue_);
  }

  /// Whether the materials of the surface belong to the compliance: false for a tissue that changes the compliance of
  /// the one that has the surface.
  bool has_contact_materials() const noexcept { return functions_->has_contact_materials; }
  bool can_be_cut() const noexcept {
    return functions_->try_cut != nullptr && (functions_->can_be_cut == nullptr || functions_->can_be_cut(tissue_));
  }
  /// Whether the surface may be empty at first.
  bool gains_pieces() const noexcept {
    return functions_->gains_pieces != nullptr && functions_->gains_pieces(tissue_);
  }
  /// Requests a cut along the surface swept by a blade, world frame; false when the tissue cannot be cut, or not now.
  bool try_cut(const BladeSweep& sweep) const noexcept { return can_be_cut() && functions_->try_cut(tissue_, sweep); }
  /// A blade for this tissue, with a coupling of that stiffness [N/m]; null when the tissue cannot be cut. Throws
  /// bad_argument for an invalid blade or stiffness. Allocates.
  std::unique_ptr<detail::ServoBlade> make_blade(const BladeTool& tool, double stiffness) const {
    return can_be_cut() ? functions_->make_blade(tool, stiffness) : nullptr;
  }

 private:
  template <class T>
  static const detail::TissueFunctions* functions_of() noexcept {
    detail::explain_tissue<T>();
    if constexpr (TissueModel<T>)
      return &detail::TissueCalls<T>::functions;
    else
      return nullptr;
  }

  void* tissue_;
  const detail::TissueFunctions* functions_;
  const ContactSurface* surface_;
};

inline Matrix3 TissueView::half_space_map_at(const detail::ContactSample& point) const noexcept {
  const Matrix3 first = half_space_map(point.vertices[0]);
  Matrix3 mean = first;  // exact where all are equal
  for (std::size_t a = 1; a < 3; ++a)
    if (point.weights[a] > 0.0) mean += point.weights[a] * (half_space_map(point.vertices[a]) - first);
  return mean;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/servo_blade.ipp>
#endif
