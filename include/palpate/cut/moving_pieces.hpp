// Pieces that are cut off, as rigid bodies that fall, rest on tissue and are grasped.
#pragma once

#include <palpate/concepts/tissue_claim.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/detail/interface_tissue.hpp>
#include <palpate/core/thread_exchange.hpp>
#include <palpate/cut/detached_piece.hpp>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <mutex>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How pieces move.
struct PieceParameters {
  double step = 2e-3;                ///< [s]
  Vector3 gravity{0.0, 0.0, -9.81};  ///< world frame [m/s^2]
  double friction = 0.2;             ///< Coulomb's coefficient between pieces and tissue, which counts as at rest
};

/// A piece as it is now.
struct MovingPiece {
  int id = -1;
  std::shared_ptr<const DetachedPiece> shape;              ///< where it was when it was added
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< maps that to where it is, both in the world frame
  Vector3 velocity = Vector3::Zero();                      ///< of its centre of mass [m/s]
};

/// Rigid pieces, one tissue for TouchingTissues: there they touch the organs and each other, and tools touch and grasp
/// them. Pieces of the tissues named with `take_from` come as soon as they are cut off, where and as they are deformed
/// then, and are removed from that tissue; any other rigid body may be added, too.
///
/// A step is that of the symplectic Euler method, exact in free flight at the ends of steps. Forces at the end of a
/// step correct it (as MovingTissue): between two steps ticks have the positions at the end of the present one without
/// forces, and the compliance step^2 J M^-1 J^T. Impacts are inelastic: forces of tissue do not add to the speed at
/// which a piece leaves. Friction slows a piece and its rotation about the normal; the tissue does not feel it. While a
/// tool touches it, a piece lighter than step^2 2000 N/m has that inertia, and its own weight: the forces of tool and
/// tissue, which are found in turn, would throw it away. One step costs O(vertices).
///
/// Threads: as MovingTissue; the functions for any thread wait for a step in progress. Satisfies TissueModel. Vertices
/// keep their numbers, also when pieces are removed; `clear` begins again.
class MovingPieces {
 public:
  /// Largest number of forces of tools or tissues on vertices; others are not applied (degraded_model).
  static constexpr std::size_t most_forces = 3 * ContactProblem::maximum_capacity;

  /// Throws bad_argument for a step that is not positive, gravity that is not finite, or negative friction.
  explicit MovingPieces(const PieceParameters& parameters = {});
  MovingPieces(const MovingPieces&) = delete;
  MovingPieces& operator=(const MovingPieces&) = delete;

  // Any thread but the one that ticks

  /// Takes the pieces that are cut off a static tissue from now on; to be called before both are given to a
  /// TouchingTissues, the tissue before the pieces. The tissue must outlive this object. Those that have been cut off
  /// before come with its next cut. Throws bad_density for a tissue without, bad_argument for one that is named
  /// already.
  template <class E, class M, class Solver>
  void take_from(HapticFEModel<E, M, Solver>& tissue) {
    static_assert(
        !detail::MovesBesideOthers<HapticFEModel<E, M, Solver>>,
        "palpate: pieces of tissue that moves are added by the thread that draws: `add` with detached_pieces");
    if (takes_from(&tissue))
      raise(SetupErrorKind::bad_argument, "pieces taken from one tissue twice", "Call take_from once per tissue");
    for (const double density : tissue.body().density)
      if (!(density > 0.0))
        raise(SetupErrorKind::bad_density, "pieces of a tissue without density", "Give the material a density");
    const std::scoped_lock lock(changes_);
    sources_.push_back(
        {&tissue, [&tissue] { return detached_pieces(tissue); },
         [&tissue](const std::vector<Index>& elements) { tissue.cut(CutOrder{.remove = elements, .open = {}}); }});
  }
  /// Adds a rigid body from the next step on, world frame; returns its id. Throws bad_density for a body without mass
  /// or inertia, bad_argument for one without triangles, non_finite, index_out_of_range for a triangle with a point
  /// that does not exist.
  int add(DetachedPiece piece, const Vector3& velocity = Vector3::Zero());
  /// Removes a piece from the next step on. Throws index_out_of_range for an id that does not exist.
  void remove(int id);
  /// Removes all pieces; ids begin at 0 again. Not while a tick or a step runs; call TouchingTissues::reset afterwards.
  /// After `reset` of a tissue that pieces come from: that tissue first, then `clear`, then TouchingTissues.
  void clear();
  /// All pieces. Allocates.
  std::vector<MovingPiece> pieces() const;
  /// World frame [m/s^2]. Throws bad_argument where it is not finite.
  void set_gravity(const Vector3& gravity);

  // The thread that steps

  BackgroundStep background_work();
  /// Steps made so far.
  std::uint64_t steps() const noexcept { return steps_; }
  double step() const noexcept { return parameters_.step; }

  // The thread that steps, between two steps: for contact with other tissues (TouchingTissues)

  void set_contact_forces(std::span<const VertexForce> forces) { others_.assign(forces.begin(), forces.end()); }
  const ContactSurface& newest_surface() const noexcept { return newest_->surface; }
  std::uint64_t newest_surface_number() const noexcept { return newest_->number; }
  std::shared_ptr<ContactProblem> newest_contact() const noexcept { return newest_->contact; }
  Matrix3 newest_compliance(int i, int j) const noexcept { return newest_->compliance(i, j); }
  /// The piece of every triangle.
  std::span<const Index> newest_parts() const noexcept { return parts_; }
  bool takes_from(const void* tissue) const;
  /// Takes the pieces that a cut has just detached from this tissue, if they belong here.
  void take_pieces(const void* tissue);

  // TissueModel: the thread that ticks

  Status begin_tick() noexcept;
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce> points = {}) noexcept;
  const ContactSurface& contact_surface() const noexcept { return views_.front().surface; }
  const Eigen::Isometry3d& to_world() const noexcept { return to_world_; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept { return views_.front().compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return views_.front().revision; }
  double compliance_bound(int j) const noexcept { return views_.front().bound[static_cast<std::size_t>(j)]; }
  double compliance_floor() const noexcept { return views_.front().floor; }
  std::uint64_t updates() const noexcept { return views_.front().revision; }
  void exchange_contacts(ContactProblem& problem) noexcept;
  /// Makes the contact points of pieces for the tools of a session that begins.
  void prepare_tools(const ToolRadii& radii, const ContactParameters& contact);
  NoHook prefetch(std::span<const int>) noexcept { return {}; }
  NoHook try_cut(const BladeSweep&) noexcept { return {}; }
  NoHook half_space_map(int) const noexcept { return {}; }
  bool gains_pieces() const noexcept { return true; }
  void report_slow(bool slow) noexcept { slow_.store(slow, std::memory_order_relaxed); }
  void report_failed(bool failed) noexcept { failed_.store(failed, std::memory_order_relaxed); }
  TissueClaim& claim() noexcept { return claim_; }

 private:
  struct Source {
    const void* tissue;
    std::function<std::vector<DetachedPiece>()> find;
    std::function<void(const std::vector<Index>&)> remove;
  };
  /// Centre of mass and rotation since the piece was added.
  struct Place {
    Vector3 centre = Vector3::Zero();
    Matrix3 rotation = Matrix3::Identity();
  };
  struct Piece {
    std::shared_ptr<const DetachedPiece> shape;
    std::vector<Vector3> arms;  // from the centre, at the start
    double radius = 0.0;        // longest of them
    Matrix3 inverse_inertia;    // at the start
    Place now, free;            // free: at the end of the present step without forces
    Vector3 velocity = Vector3::Zero(), angular_momentum = Vector3::Zero();
    double mobility = 1.0;  // factor on its motion by forces and gravity; less while a tool touches it
    int after_tool = 0;     // number of steps for which this lasts
    std::size_t first = 0;  // of its vertices
    bool is_fresh = true;   // added since the last step
    bool is_removed = false;
  };
  struct Load {
    Vector3 force = Vector3::Zero(), moment = Vector3::Zero();
  };
  struct View {
    ContactSurface surface;
    std::vector<int> piece;        // of every vertex
    std::vector<Vector3> arm;      // of every vertex
    std::vector<double> bound;     // of every vertex [m/N]
    std::vector<double> by_force;  // of every piece: step^2 / mass [m/N]
    std::vector<Matrix3> by_moment;
    double floor = 1e-12;
    std::uint64_t revision = 0, number = 0;  // of positions; of triangles
    std::shared_ptr<ContactProblem> contact;
    bool left_out = false;
    Matrix3 compliance(int i, int j) const noexcept;
  };
  struct Forces {
    std::vector<VertexForce> item;
    std::size_t count = 0;
  };

  Matrix3 inverse_inertia(const Piece& piece, const Matrix3& rotation) const noexcept;
  Piece make_piece(DetachedPiece piece, const Vector3& velocity) const;
  void reserve(std::span<const Piece> more);
  void insert(Piece&& piece) noexcept;
  void add_loads(std::span<const VertexForce> forces, std::vector<Load>& loads) const noexcept;
  void correct(Piece& piece, const Load& tools, const Load& others) const noexcept;
  void slow_down(const Piece& piece, const Vector3& force, Vector3& velocity, Vector3& angular_momentum) const noexcept;
  void predict(Piece& piece) const noexcept;
  void make_surface();
  void publish();

  static constexpr double largest_compliance = 5e-4;  // of a step [m/N]: softer, tools and tissue move it in turn
  static constexpr int steps_after_tool = 25;

  PieceParameters parameters_;
  Eigen::Isometry3d to_world_ = Eigen::Isometry3d::Identity();
  mutable std::mutex changes_;
  std::vector<Source> sources_;
  std::vector<Piece> pieces_;
  bool changed_ = false;  // pieces since the surface was made
  ContactSurface surface_;
  std::shared_ptr<ContactProblem> contact_;
  bool left_out_ = false;
  std::vector<int> piece_of_;
  std::vector<Index> parts_;
  std::uint64_t steps_ = 0, revision_ = 0, number_ = 0;
  ToolRadii radii_ = 0.0;  // 0: no session yet
  ContactParameters contact_parameters_;
  std::vector<VertexForce> others_;
  std::vector<Load> by_tools_, by_others_;
  std::vector<Vector3> positions_;
  TripleBuffer<View> views_;
  TripleBuffer<Forces> given_;
  const View* newest_ = nullptr;
  Status ticked_;
  std::atomic<bool> slow_{false}, failed_{false};
  std::uint64_t seen_ = 0;
  TissueClaim claim_;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/cut/moving_pieces.ipp>
#endif
