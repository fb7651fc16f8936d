// The rows of the contact problem of a tick.
#pragma once

#include <palpate/contact/coulomb_friction.hpp>
#include <palpate/contact/detail/candidates.hpp>
#include <palpate/contact/detail/complementarity.hpp>
#include <palpate/contact/detail/point_compliance.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Up to `capacity` candidates that press or might, as rows of W lambda + b: adds and drops them, builds W from the
/// tissue's compliance, solves, and hands forces and displaced points back. Nothing allocates after construction.
class ContactRows {
 public:
  /// Allocates workspaces; for set-up.
  ContactRows(int vertices, double friction, int capacity);

  /// Forgets the compliance between points when the tissue's has changed.
  void begin_tick(std::uint64_t compliance_revision) noexcept;
  void clear() noexcept;
  /// Back to the state after construction.
  void reset() noexcept;
  /// Without rows, on a surface with more vertices, that `fresh` was made for.
  void move_to(ContactRows& fresh) noexcept;

  int capacity() const noexcept { return capacity_; }
  int count() const noexcept { return count_; }
  std::span<const Contact> contacts() const noexcept { return {rows_.data(), at(count_)}; }
  Candidate& candidate(int row) noexcept { return *candidate_[at(row)]; }

  /// There is always room: the caller has seen to it.
  void add(const ContactSurface& surface, const Candidates& candidates, Candidate& c) noexcept;
  /// Rows without force make room; W has to be built anew. False when there are none.
  bool drop_idle() noexcept;
  /// Asks for the compliance columns of all vertices that carry rows.
  Status require_columns(const TissueView& tissue) noexcept;

  /// Rows `first` and later of W = J C J^T plus the coupling and `floor` [m/N], and of b = gap at the target without
  /// contact force.
  void build(const TissueView& tissue, const ContactSamples& samples, std::span<const ContactTool> tools, double floor,
             int first) noexcept;
  /// Presses: with the drags as they are. False when the forces are a cut-off answer.
  bool solve() noexcept;
  /// Drags, and presses once more: each exact for the other (Panagiotopoulos 1975); linearisations and ticks go on with
  /// it. False when the forces are a cut-off answer.
  bool slide() noexcept;
  bool has_friction() const noexcept { return friction_.acts(); }
  /// How far the tools would go in without contact force, at the deepest row built [m].
  double deepest_push() const noexcept;

  /// Hands the answer to points, vertices and tools.
  void apply(std::span<ContactTool> tools, SurfaceDisplacement& displacement, Candidates& candidates) noexcept;
  /// At the end of a tick: what slipped clings where it is now; what sticks keeps its place.
  void stick(std::span<const ContactTool> tools) noexcept;

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  inline bool sticks(const Candidate& c) const noexcept;
  inline static void reach(const ContactTool& tool, const Candidate& c, Contact& row) noexcept;
  void build_friction(const TissueView& tissue, const ContactSamples& samples, const ContactTool& tool, int i) noexcept;
  inline Matrix3 between(const TissueView& tissue, const ContactSamples& samples, int i, int j) noexcept;
  inline static Vector3 sprung(const ContactTool& tool, const Contact& row) noexcept;
  void note_drags(std::span<ContactTool> tools) const noexcept;
  inline static double set_responses(const double* c, const double* m, const double* n, double* of_n,
                                     double* of_m) noexcept;
  inline void build_row(const TissueView& tissue, const ContactSamples& samples, const ContactTool& tool,
                        int i) noexcept;
  inline Vector3 moved_point(int i) const noexcept;

  /// Of a row's point to unit force on another.
  Vector3& response(int i, int j) noexcept { return response_[at(i) * at(capacity_) + at(j)]; }
  const Vector3& response(int i, int j) const noexcept { return response_[at(i) * at(capacity_) + at(j)]; }

  int capacity_, count_ = 0;
  ComplementarityProblem problem_;
  CoulombFriction friction_;
  std::vector<double> free_gap_, pressing_before_;
  double floor_ = 0.0;
  std::uint64_t tick_ = 0;
  PointCompliance compliance_;
  std::vector<Contact> rows_;
  std::vector<Candidate*> candidate_;
  std::vector<Vector3> response_;
  std::vector<int> vertices_;
  std::vector<int> slot_;  // scratch per vertex: -1 between calls
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/contact_rows.ipp>
#endif
