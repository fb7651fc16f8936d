// The contact between deformable bodies: one complementarity problem for all of them.
#pragma once

#include <palpate/contact/detail/complementarity.hpp>
#include <palpate/contact/detail/interface_rows.hpp>
#include <palpate/contact/detail/interface_tissue.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Finds the forces between bodies whose compliance is known, so that none enters another one: Signorini's conditions
/// on mortar gaps, and on vertices and edges that would enter another body where no mean gap keeps them out. W = sum of
/// J C J^T over the bodies of a row (Duriez, Dubois, Kheddar and Andriot 2006). Rigid parts that move far at once are
/// kept out along their path: the first linearisation is at the last solution. The normals and weights are those of
/// the deformed surfaces: the problem is solved again until these stay. Rows that hardly change keep their columns J C.
/// Allocates; for a background thread.
class InterfaceProblem {
 public:
  /// Of at most `capacity` rows; with self contact also of each tissue with itself. The tissues must outlive it. The
  /// compliance columns of all their vertices are available.
  InterfaceProblem(std::vector<InterfaceTissue> tissues, int capacity, bool self_contact);

  /// For a present surface and pose of a tissue, under these forces of tools. Where its triangles have changed, rows
  /// between vertices that still exist keep their forces.
  void load(std::size_t body, std::span<const VertexForce> tools);
  /// Finds the forces for these loads. Flags solver_not_converged, degraded_model (more rows than the capacity),
  /// large_displacement (bodies overlap at rest by a tenth of the thinner one), lost_contact (a vertex or an edge is
  /// inside another body or part) and coarse_contact (few rows press: the surfaces are too coarse for the contact).
  Status solve();

  struct Row {
    InterfaceRow row;
    double force = 0.0;                             ///< >= 0 [N]
    double followed = 0.0;                          ///< the same for the forces of tools since: see `follow`
    double gap = 0.0;                               ///< without the forces of rows [m]
    std::array<std::vector<double>, 2> response{};  ///< C J^T of both bodies, 3 per vertex [m/N]; of one where it
                                                    ///< touches itself
    bool stale = false;                             ///< whether a body has another compliance since
    double response_of(std::size_t side, int vertex, const Vector3& direction) const noexcept {
      const double* const u = response[side].data() + 3 * vertex;
      return u[0] * direction[0] + u[1] * direction[1] + u[2] * direction[2];
    }
    /// Of response; -1 for a body that is not part of it.
    int side_of(int body) const noexcept { return row.key.body == body ? 0 : row.key.other == body ? 1 : -1; }
  };
  std::span<const Row> rows() const noexcept { return rows_; }
  /// The surface under the forces of tools, without those of rows, model frame [m].
  std::span<const Vector3> base(std::size_t body) const noexcept { return bodies_[body].base; }
  /// The number of the surface that was loaded last.
  std::uint64_t surface_number(std::size_t body) const noexcept { return bodies_[body].number; }
  /// Displacement by the rows' forces, 3 per vertex, model frame [m].
  void displacement(std::size_t body, std::vector<double>& u) const;
  /// Updates `followed` for forces of tools that have changed since `solve`, with the same rows closed. `pushed`: sum
  /// of Z f over the changes of all bodies.
  void follow(const VectorX& pushed);
  /// Forgets all rows.
  void clear() noexcept {
    rows_.clear();
    pressing_.clear();
  }
  /// The rows' forces on the vertices of a body, as `follow` has them.
  void forces(std::size_t body, std::vector<VertexForce>& forces) const;
  /// Number of rows that press.
  int pressing() const noexcept { return static_cast<int>(pressing_.size()); }
  /// While the rows that press stay closed, a body has the compliance C_ij - Z_i^T Z_j. Z has as many rows as press;
  /// the three columns of every vertex are contiguous. O(rows^2 x vertices).
  void restraint(std::size_t body, std::vector<double>& z);

 private:
  struct Body {
    InterfaceTissue tissue;
    Eigen::Isometry3d pose;
    std::vector<Vector3> base{}, now{};  // under the loads of tools, model frame; with rows, world frame
    std::vector<Triangle> triangles{};
    std::vector<std::array<int, 2>> edges{};
    std::vector<double> depths{};
    std::vector<Index> parts{};
    Bvh bvh{};
    double facet_length = 0.0, deepest = 0.0;  // mean; largest of depths
    double path = 0.0;                         // of parts, from the last solution without forces of rows [m]
    std::uint64_t revision = 0, number = 0;    // of the surface; of its triangles
    std::vector<double>
        closed_gap{};  // per vertex: the mean gap of its row that presses, or is negative; else infinite
  };
  /// Of a depth, half of the thickness: what is deeper has come through from the other side.
  static constexpr double beyond_middle = 1.9;
  static std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  static Body make_body(const InterfaceTissue& tissue);
  InterfaceSurface surface(std::size_t body) const noexcept;
  Vector3 direction(const InterfaceRow& row, int body) const noexcept;
  bool find_paths() noexcept;
  void mark_stale(std::size_t body) noexcept;
  void renew(std::size_t body);
  double move_bodies();
  bool keeps_shape() const noexcept;
  void find_rows(bool along_paths);
  void find_responses();
  void limit_rows(Status& status);
  void assemble();
  bool find_forces();
  /// The facet of another body that a vertex is nearest to, if it is above or below it.
  struct NearestFacet {
    int facet = -1;
    double height = 0.0;  // of the vertex above it [m]
    std::array<double, 3> weights{};
    Vector3 normal = Vector3::Zero();
  };
  /// `except`: a part whose facets do not count; -1 for none.
  NearestFacet find_nearest(const Body& other, const Vector3& p, Index except = -1) const noexcept;
  NearestFacet find_opposite(const Body& own, const Body& other, int v) const noexcept;
  void add_entered(std::size_t own, std::size_t other);
  /// Where an edge goes through another body: the middle of that part, and the nearest way out.
  struct Crossing {
    double along = 0.0, depth = 0.0;  // part of the edge; [m]
    int facet = -1;                   // of the other body
    std::array<double, 3> weights{};
    Vector3 out = Vector3::Zero();  // unit
  };
  Crossing find_crossing(const Body& other, const Vector3& from, const Vector3& to) const noexcept;
  /// Calls visit(vertex, end, crossing) for the edges of a body that go through another one, where no mean gap is
  /// closed.
  template <class Visit>
  void visit_crossings(const Body& own, const Body& other, Visit&& visit) const;
  void add_crossings(std::size_t own, std::size_t other);
  bool is_opposite(const InterfaceRow& row, double length) const noexcept;
  void note_closed(std::span<const InterfaceRow> rows);
  bool may_enter(const Body& body, int vertex, double height, double length) const noexcept;
  const Row* pressed_row(const InterfaceKey& key) const noexcept;
  bool overlap_at_rest();
  bool is_coarse() const noexcept;
  bool has_entered() const noexcept;
  bool parts_have_entered(const Body& body) const noexcept;
  void factor_pressing();

  std::vector<Body> bodies_;
  std::vector<double> column_, moved_, factor_, chunk_, answer_;
  InterfaceRows geometry_;
  std::vector<Row> rows_, before_;  // sorted by key
  std::vector<std::size_t> pressing_;
  ComplementarityProblem problem_;
  int capacity_;
  bool self_contact_;
  bool moved_at_rest_ = true;  // since the overlap at rest was found
  bool overlaps_ = false;      // at rest
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/interface_problem.ipp>
#include <palpate/contact/detail/interface_problem_entered.ipp>
#endif
