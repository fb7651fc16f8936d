// Tissues that touch each other.
#pragma once

#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/detail/interface_problem.hpp>
#include <palpate/contact/detail/near_compliance.hpp>
#include <palpate/contact/detail/requested_vertices.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/core/thread_exchange.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How the contact between tissues is found.
struct TissueContactOptions {
  int capacity = 512;         ///< of gaps between all tissues, 1 to 1024; of more, the smallest are kept
  double interval = 0.01;     ///< between two solutions, which also follow every step of a tissue that moves [s]
  bool self_contact = false;  ///< also each tissue with itself
};

class TouchingTissues;

/// A tissue as tools feel it: moved by the tissues that it touches, with a compliance that includes them. Satisfies
/// TissueModel; for one servo at a time. Part of TouchingTissues. Ticks read blocks of the compliance that are ready
/// near the tools; another block costs 9 multiplications per gap that presses. Where the tissue can be cut, blades cut
/// it, and ticks report degraded_model until they feel the cut.
class TouchingTissue {
 public:
  TouchingTissue(const TouchingTissue&) = delete;
  TouchingTissue& operator=(const TouchingTissue&) = delete;

  const ContactSurface& contact_surface() const noexcept { return views_.front().surface; }
  const Eigen::Isometry3d& to_world() const noexcept { return tissue_.view().to_world(); }
  Status require_columns(std::span<const int> vertices) noexcept;
  Matrix3 compliance(int i, int j) const noexcept;
  Vector3 displacement_of(int i, std::span<const VertexForce> forces) const noexcept;
  std::uint64_t compliance_revision() const noexcept { return revision_; }
  /// No block of a symmetric positive matrix is larger than the geometric mean of those on the diagonal.
  double compliance_bound(int j) const noexcept;
  double compliance_floor() const noexcept { return tissue_.view().compliance_floor(); }

  NoHook prefetch(std::span<const int>) noexcept { return {}; }
  Status begin_tick() noexcept;
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points = {}) noexcept;
  std::uint64_t updates() const noexcept { return updates_.load(std::memory_order_relaxed); }
  void exchange_contacts(ContactProblem& problem) noexcept;
  /// Waits for a step or solution in progress.
  void prepare_tools(const ToolRadii& radii, const ContactParameters& parameters);
  bool try_cut(const BladeSweep& sweep) noexcept { return tissue_.view().try_cut(sweep); }
  bool can_be_cut() const noexcept { return tissue_.view().can_be_cut(); }
  bool gains_pieces() const noexcept { return tissue_.has_parts(); }
  Matrix3 half_space_map(int v) const noexcept { return tissue_.view().half_space_map(v); }
  NoHook background_work() noexcept { return {}; }
  NoHook report_slow(bool) noexcept { return {}; }
  NoHook report_failed(bool) noexcept { return {}; }
  TissueClaim& claim() noexcept { return claim_; }
  std::vector<std::string> notes() const { return tissue_.view().notes(); }
  bool refuses_suspicious_units() const noexcept { return tissue_.view().refuses_suspicious_units(); }

 private:
  friend class TouchingTissues;
  struct View {
    ContactSurface surface;
    std::vector<double> restraint{};  // Z of C_ij - Z_i^T Z_j, `rows` x 3 per vertex
    int rows = 0;
    detail::NearCompliance near_compliance{};
    Status status{};
    std::uint64_t number = 0;                               // of the surface: changes of its triangles
    detail::RequestedVertices near_room{}, pressed_room{};  // of a tick on a surface with other triangles
    std::shared_ptr<ContactProblem> contact{};              // for a session to continue with
  };
  struct Forces {
    std::vector<VertexForce> item;
    std::size_t count = 0;
    detail::VertexCopy near_vertices, pressed;  // of ticks since the surface was taken
    std::span<const VertexForce> all() const noexcept { return {item.data(), count}; }
  };
  /// Of vertices whose compliance is ready for a tick; that of others is evaluated there.
  static constexpr std::size_t most_near = 512, most_pressed = 192;
  /// Forces of a tick on a tissue that gains vertices.
  static constexpr std::size_t most_on_parts = 3 * std::size_t{ContactProblem::maximum_capacity};

  TouchingTissue(const detail::InterfaceTissue& tissue, TouchingTissues& owner, int capacity);

  using Block = Eigen::Map<const Eigen::Matrix<double, Eigen::Dynamic, 3>>;
  static Block restraint(const View& view, int v) noexcept {
    return {view.restraint.data() + 3 * static_cast<std::ptrdiff_t>(view.rows) * v, view.rows, 3};
  }
  void take_view() noexcept;
  /// Makes the view one of the newest triangles. Allocates.
  void renew(View& view, std::uint64_t number);
  static Matrix3 restrained(const View& view, int i, int j, const Matrix3& c) noexcept;
  /// For the thread that solves: the surface as tools do not press it, with the rows closed as they are. With the
  /// forces of the last tick, its compliance gives the surface that was found.
  void publish(detail::InterfaceProblem& problem, std::size_t body, Status status);
  /// Moves the surface to where the tissue is without the tools of ticks.
  void move_surface(View& view, const VectorX& pushed, detail::InterfaceProblem& problem, std::size_t body);
  void set_forces_for_blades(std::span<const VertexForce> of_others, std::span<const VertexForce> of_tools);
  /// Sum of Z f over forces.
  static VectorX pushed_by(const View& view, std::span<const VertexForce> forces);

  TouchingTissues& owner_;
  detail::InterfaceTissue tissue_;
  detail::ClaimedTissue claimed_;
  double largest_bound_ = 0.0;
  std::shared_ptr<const ForceAccuracy> accuracy_;
  TripleBuffer<View> views_;
  TripleBuffer<Forces> given_;
  TripleBuffer<std::vector<VertexForce>> drawn_;
  mutable detail::RequestedVertices near_;
  mutable VectorX sum_;  // of Z f, a row each
  detail::RequestedVertices pressed_;
  const View* newest_ = nullptr;  // published last; stays unchanged until the next one is published
  VectorX pushed_;                // at that time: sum of Z f
  std::vector<double> moved_;
  Status of_tissue_;                          // of the last begin_tick of a tissue that changes
  std::uint64_t number_ = 0, exchanged_ = 0;  // of the surface that a tick has, and the session's contact problem
  std::uint64_t revision_ = 0, published_ = 0;
  std::atomic<std::uint64_t> updates_{0};
  std::atomic<bool> slow_{false}, failed_{false};
  std::atomic<bool> is_behind_{false};   // a cut is being made, or made and not published
  std::atomic<std::uint64_t> taken_{0};  // number of the surface that ticks have, of those published
  int postponed_ = 0;                    // how many times the next cut has been
  Status ticked_;
  TissueClaim claim_;
};

/// Contact between deformable tissues, solved in a background thread; ticks feel each tissue with its neighbours behind
/// it. For static tissues whose compliance columns are all stored, and for tissues that move or are cut, whose steps
/// and cuts this object makes. Pieces that are cut off touch nothing, except where MovingPieces takes them.
///
/// Gaps are those of mortar elements on the deformed surfaces, which pass a uniform pressure exactly between any
/// meshes. The forces between two tissues are in equilibrium to rounding. In every solution the forces of the tools in
/// the last tick are taken, and all gaps are solved as one complementarity problem, without friction. Until the next
/// solution the gaps that press stay closed: a tool feels a tissue with the compliance C - C J^T (J C J^T)^-1 J C. A
/// steady force is thus that of one solution of all tissues, and its change is exact as long as no other gap opens or
/// closes. Forces on one tissue reach the tools at another one with the next solution. Vertices and edges that would
/// enter another tissue where no mean gap keeps them out have rows of their own. Contacts of few facets, and edge
/// against edge, are coarse: docs/simulator.md.
///
/// A session takes `group()`, a BackgroundWorker takes this object; the tissues have no worker of their own. Refers to
/// the tissues, which must outlive it; a tissue belongs to one such object, and sessions use it through this one only.
/// Poses and loads of tissues that do not move must not change while a tick or a solution runs; after `reset` of one
/// that moves or is cut, also not beside them, call that of this object. The forces of the last tick stay until the
/// next one: call `HapticServo::release` at the end.
class TouchingTissues {
 public:
  /// Of at least two tissues, or one with self contact. Solves up to ten times; allocates. Throws unsupported for a
  /// tissue that stiffens, for a static one whose columns are not all stored, and with self contact for one that can be
  /// cut; bad_argument for a tissue without touchable surface, for pieces before the tissue that they come from, and
  /// for options that make no sense; TissueClaim's error for a tissue that moves or is cut and that a servo uses.
  template <class... T>
  requires(sizeof...(T) > 1 && (TissueModel<T> && ...)) explicit TouchingTissues(T&... tissues)
      : TouchingTissues(TissueContactOptions{}, tissues...) {}
  template <class... T>
  requires(sizeof...(T) > 0 && (TissueModel<T> && ...)) explicit TouchingTissues(const TissueContactOptions& options,
                                                                                 T&... tissues)
      : TouchingTissues(std::vector<detail::InterfaceTissue>{detail::InterfaceTissue(tissues)...}, options) {}

  /// The tissues as tools feel them, in the order given.
  TissueGroup group();
  std::size_t size() const noexcept { return tissues_.size(); }
  /// One of them, for example for a group with friction of its own. Throws index_out_of_range.
  TouchingTissue& tissue(std::size_t k);

  /// The next step of a tissue that moves, cut, or solution of the contact; for BackgroundWorker.
  BackgroundStep background_work();
  /// Finds the contact forces for the forces of tools in the last tick, without a step or cut. Allocates; per
  /// linearisation, of which there are up to eight, O(gaps^3 + changed gaps x vertices), and O(pressing gaps^2 x
  /// vertices) for the ticks.
  void solve();
  /// Forgets all forces and solves again, after `reset` of a tissue. Not while a tick or a solution runs.
  void reset();
  void report_slow(bool slow) noexcept;
  void report_failed(bool failed) noexcept;

  /// Forces of the other tissues on the vertices of one, as found last; for one drawing thread. A tissue that does not
  /// move is drawn with these and those of the tools. Valid until the next call for that tissue.
  std::span<const VertexForce> contact_forces(std::size_t k);

  /// Of the last solution.
  struct Report {
    int rows = 0, pressing = 0;  ///< gaps that are open or closed, and those that press
    double force = 0.0;          ///< sum of the magnitudes of all forces, in any direction [N]
    Status status;
  };
  /// From any thread; waits for a step or solution in progress.
  Report report() const {
    const std::scoped_lock lock(changes_);
    return report_;
  }

 private:
  friend class TouchingTissue;
  void take_forces();
  bool work(std::size_t k);
  static bool postpone_cut(TouchingTissue& tissue) noexcept;
  void follow_ticks(std::size_t k);
  void find_forces();
  TouchingTissues(std::vector<detail::InterfaceTissue> tissues, const TissueContactOptions& options);

  TissueContactOptions options_;
  mutable std::mutex changes_;  // of what follows
  std::vector<std::unique_ptr<TouchingTissue>> tissues_;
  std::unique_ptr<detail::InterfaceProblem> problem_;
  double time_ = 0.0, next_solution_ = 0.0;  // of what was done [s]
  std::vector<double> next_work_;            // of the tissues; infinite for one without
  std::vector<VertexForce> forces_;
  Report report_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/touching_tissues.ipp>
#endif
