// What a tick needs of a body that is cut, in one piece.
#pragma once

#include <palpate/contact/contact_problem.hpp>
#include <palpate/cut/cut_surface.hpp>
#include <palpate/cut/cut_system.hpp>

namespace palpate::inline PALPATE_ABI {

/// Surface, compliance and contact problem after a cut: made by the thread that cuts, read and driven by the one that
/// ticks.
struct CutView {
  ContactSurface surface;
  std::shared_ptr<const CutStep> step;
  std::vector<std::array<Index, 3>> place;  ///< per vertex its dofs in the compliance, -1: held, or gone
  std::vector<double> bound;                ///< per vertex [m/N]
  double floor = 1e-9;                      ///< [m/N]
  ContactProblem<> problem;
  Status status;
  std::uint64_t cut = 0;  ///< views of one cut have the same surface and, up to rounding, the same compliance

  template <Element E>
  CutView(const CutSystem<E>& system, const CutSurface<E>& touchable, std::vector<Vector3> positions,
          std::shared_ptr<const CutStep> given, double radius, const ContactParameters& contact)
      : surface(std::move(positions), touchable.triangles()),
        step(std::move(given)),
        place(touchable.nodes().size(), {-1, -1, -1}),
        problem(surface, radius, contact) {
    for (std::size_t v = 0; v < place.size(); ++v)
      for (int c = 0; c < 3; ++c)
        if (touchable.is_used(v)) place[v][static_cast<std::size_t>(c)] = system.place(touchable.nodes()[v], c);
  }

  /// Displacement of vertex i per force on j [m/N].
  Matrix3 compliance(int i, int j) const noexcept {
    const auto &a = place[static_cast<std::size_t>(i)], &b = place[static_cast<std::size_t>(j)];
    Matrix3 block;
    for (std::size_t c = 0; c < 3; ++c)
      for (std::size_t r = 0; r < 3; ++r)
        block(static_cast<Index>(r), static_cast<Index>(c)) = a[r] < 0 || b[c] < 0 ? 0.0 : (*step)(a[r], b[c]);
    return block;
  }

  /// Bounds from those before the step: what it adds is at most the longest z times y of the vertex. Vertices with
  /// columns of their own are summed up.
  void bound_by(const std::vector<double>& before) {
    double longest = 0.0;
    for (const auto& p : place) longest = std::max(longest, std::sqrt(squares(step->z, p)));
    bound.assign(place.size(), 0.0);
    for (std::size_t v = 0; v < place.size(); ++v) {
      const bool known = v < before.size() && std::ranges::all_of(place[v], [&](Index p) { return p < step->old; });
      bound[v] = known ? before[v] + longest * std::sqrt(squares(step->y, place[v])) : exact_bound(v);
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
    bound.assign(place.size(), 0.0);
    for (std::size_t v = 0; v < place.size(); ++v) bound[v] = exact_bound(v);
    set_floor();
  }

 private:
  double squares(const MatrixX& columns, const std::array<Index, 3>& at) const noexcept {
    double sum = 0.0;
    for (const Index p : at)
      if (p >= 0 && p < columns.cols()) sum += columns.col(p).squaredNorm();
    return sum;
  }
  double exact_bound(std::size_t j) const noexcept {
    double largest = 0.0;
    for (std::size_t i = 0; i < place.size(); ++i)
      largest = std::max(largest, compliance(static_cast<int>(i), static_cast<int>(j)).squaredNorm());
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

}  // namespace palpate::inline PALPATE_ABI
