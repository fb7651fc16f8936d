// The data of a body under cuts that a tick needs, in one object.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/contact/contact.hpp>
#include <palpate/contact/contact_problem.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_step.hpp>
#include <palpate/cut/detail/cut_surface.hpp>
#include <palpate/cut/detail/cut_system.hpp>

#include <array>
#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Removes triangles with an edge longer than `longest` [m] and their entries of `elements`, if any; returns whether
/// there was one.
bool erase_stretched(const std::vector<Vector3>& positions, double longest, std::vector<Triangle>& triangles,
                     std::vector<Index>& elements);

/// Surface and contact problem after a cut, and the places of its vertices in the compliance; unchanged while the cut
/// is folded in. Made by the thread that cuts, used by the one that ticks. Triangles on weak remains that are stretched
/// beyond what contact points can cover are left out; ticks then report degraded_model.
struct CutContact {
  bool left_out = false;   ///< true if a triangle is left out
  bool too_far = false;    ///< true if the loads displace a vertex too far for linear elasticity
  bool published = false;  ///< true when ticks may read it; for the thread that cuts
  ContactSurface surface;
  std::vector<std::array<Index, 3>> dofs;  ///< per vertex its dofs in the compliance, -1: constrained or removed
  ContactProblem problem;
  std::uint64_t cut = 0;  ///< number of the cut

  /// `made` has the vertices of `touchable`, and those of its triangles that are not stretched.
  template <Element E>
  CutContact(const CutSystem<E>& system, const CutSurface<E>& touchable, ContactSurface made, const ToolRadii& radii,
             const ContactParameters& contact, std::uint64_t number)
      : left_out(made.triangles().size() < touchable.triangles().size()),
        surface(std::move(made)),
        dofs(touchable.nodes().size(), {-1, -1, -1}),
        problem(surface, radii, contact),
        cut(number) {
    for (std::size_t v = 0; v < dofs.size(); ++v)
      for (int c = 0; c < 3; ++c)
        if (touchable.is_used(v)) dofs[v][static_cast<std::size_t>(c)] = system.index_of(touchable.nodes()[v], c);
  }
};

/// The data that a tick reads between two changes. Views of one cut have the same contact and, up to rounding, the same
/// compliance.
struct CutView {
  std::shared_ptr<CutContact> contact;
  std::shared_ptr<const CutStep> step;
  std::vector<double> bound{};  ///< per vertex [m/N]
  double floor = 1e-9;          ///< [m/N]

  /// Displacement of vertex i per force on vertex j [m/N].
  Matrix3 compliance(int i, int j) const noexcept;

  /// Bounds from those before the step, which adds at most the product of the longest z and the y of the vertex. For
  /// vertices with explicit columns the bound is computed exactly.
  void bound_by(const std::vector<double>& before);
  /// Takes over the bounds of the step that has been folded in since.
  void bound_as(const std::vector<double>& before);
  /// Bounds from the compliance itself. O(vertices^2).
  void bound_exactly();

 private:
  const std::array<Index, 3>& dofs_of(int vertex) const noexcept;
  double squares(const MatrixX& columns, const std::array<Index, 3>& at) const noexcept;
  /// Largest Frobenius norm of the blocks of vertex j with all others; `row`: workspace, one entry per dof.
  double exact_bound(std::size_t j, VectorX& row) const noexcept;
  void set_floor() noexcept;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/cut/detail/cut_view.ipp>
#endif
