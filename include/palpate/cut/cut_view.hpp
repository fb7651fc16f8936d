// What a tick needs of a body that is cut, in one piece.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/cut/cut_surface.hpp>
#include <palpate/cut/cut_system.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Surface and contact problem after a cut, and where its vertices are in the compliance: the same while the cut is
/// folded in. Made by the thread that cuts, driven by the one that ticks. Triangles that hang from so little that they
/// are stretched beyond what contact points can cover are left out; ticks then say degraded_model.
struct CutContact {
  bool left_out = false;  ///< whether a triangle is
  ContactSurface surface;
  std::vector<std::array<Index, 3>> place;  ///< per vertex its dofs in the compliance, -1: held, or gone
  ContactProblem problem;
  std::uint64_t cut = 0;  ///< number of the cut

  template <Element E>
  CutContact(const CutSystem<E>& system, const CutSurface<E>& touchable, std::vector<Vector3> positions, double radius,
             const ContactParameters& contact, std::uint64_t number)
      : surface(covered(std::move(positions), touchable.triangles(), ContactSamples::maximum_subdivision * radius)),
        place(touchable.nodes().size(), {-1, -1, -1}),
        problem(surface, radius, contact),
        cut(number) {
    for (std::size_t v = 0; v < place.size(); ++v)
      for (int c = 0; c < 3; ++c)
        if (touchable.is_used(v)) place[v][static_cast<std::size_t>(c)] = system.place(touchable.nodes()[v], c);
  }

 private:
  ContactSurface covered(std::vector<Vector3> positions, std::vector<Triangle> triangles, double longest) {
    const auto is_covered = [&](const Triangle& t) {
      const auto at = [&](std::size_t i) { return positions[static_cast<std::size_t>(t[i])]; };
      return (at(0) - at(1)).norm() <= longest && (at(1) - at(2)).norm() <= longest &&
             (at(2) - at(0)).norm() <= longest;
    };
    left_out = std::erase_if(triangles, [&](const Triangle& t) { return !is_covered(t); }) > 0;
    return ContactSurface(std::move(positions), std::move(triangles));
  }
};

/// What a tick reads between two changes. Views of one cut have the same contact and, up to rounding, the same
/// compliance.
struct CutView {
  std::shared_ptr<CutContact> contact;
  std::shared_ptr<const CutStep> step;
  std::vector<double> bound{};  ///< per vertex [m/N]
  double floor = 1e-9;          ///< [m/N]

  /// Displacement of vertex i per force on j [m/N].
  Matrix3 compliance(int i, int j) const noexcept {
    const auto &a = place(i), &b = place(j);
    Matrix3 block;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t r = 0; r < 3; ++r)
        block(static_cast<Index>(r), static_cast<Index>(c)) = a[r] < 0 || b[c] < 0 ? 0.0 : (*step)(a[r], b[c]);
    return block;
  }

  /// Bounds from those before the step: what it adds is at most the longest z times y of the vertex. Vertices with
  /// columns of their own are summed up.
  void bound_by(const std::vector<double>& before) {
    const auto& places = contact->place;
    double longest = 0.0;
    for (const auto& p : places) longest = std::max(longest, std::sqrt(squares(step->z, p)));
    bound.assign(places.size(), 0.0);
    VectorX row(step->all);
    for (std::size_t v = 0; v < places.size(); ++v) {
      const bool known = v < before.size() && std::ranges::all_of(places[v], [&](Index p) { return p < step->old; });
      bound[v] = known ? before[v] + longest * std::sqrt(squares(step->y, places[v])) : exact_bound(v, row);
    }
    set_floor();
  }
  /// The bounds of the step that was folded in since.
  void bound_as(const std::vector<double>& before) {
    bound = before;
    set_floor();
  }
  /// Bounds from the compliance itself. O(vertices^2).
  void bound_exactly() {
    bound.assign(contact->place.size(), 0.0);
    VectorX row(step->all);
    for (std::size_t v = 0; v < bound.size(); ++v) bound[v] = exact_bound(v, row);
    set_floor();
  }

 private:
  const std::array<Index, 3>& place(int vertex) const noexcept {
    return contact->place[static_cast<std::size_t>(vertex)];
  }
  double squares(const MatrixX& columns, const std::array<Index, 3>& at) const noexcept {
    double sum = 0.0;
    for (const Index p : at)
      if (p >= 0 && p < columns.cols()) sum += columns.col(p).squaredNorm();
    return sum;
  }
  /// Largest Frobenius norm of the blocks that vertex j has with others; `row`: scratch, one entry per dof.
  double exact_bound(std::size_t j, VectorX& row) const noexcept {
    row.setZero();
    for (const Index p : contact->place[j])
      if (p >= 0) step->add_squares(p, row);
    double largest = 0.0;
    for (const auto& at : contact->place) {
      double sum = 0.0;
      for (const Index p : at)
        if (p >= 0) sum += row[p];
      largest = std::max(largest, sum);
    }
    return std::sqrt(largest);
  }
  void set_floor() noexcept {
    double softest = 0.0, hardest = infinity;
    for (const double b : bound) {
      softest = std::max(softest, b);
      if (b > 0.0) hardest = std::min(hardest, b);
    }
    floor = softest > 0.0 ? std::min(1e-9 * softest, 1e-7 * hardest) : 1e-9;
  }
};

}}  // namespace palpate
