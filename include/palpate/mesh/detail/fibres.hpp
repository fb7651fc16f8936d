// Checks of fibre directions.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Allowed deviation of the length of a fibre direction from one: files print six digits or fewer. Materials normalise
/// it.
inline constexpr double fibre_length_tolerance = 1e-5;

/// Refuses a number of fibres that differs from the number of elements.
inline void require_fibre_count(std::size_t fibres, Index element_count) {
  if (static_cast<Index>(fibres) != element_count)
    raise(SetupErrorKind::bad_argument, "the mesh has " + std::to_string(fibres) + " fibre directions",
          "It needs one per element, " + std::to_string(element_count) + ", or none");
}

/// Refuses fibres that are not unit vectors.
inline void require_unit_vectors(std::span<const Vector3> fibres) {
  std::vector<std::int64_t> bad;
  double worst = 1.0;
  for (std::size_t e = 0; e < fibres.size(); ++e) {
    const double length = fibres[e].norm();
    if (std::abs(length - 1.0) <= fibre_length_tolerance) continue;
    if (!(std::abs(length - 1.0) <= std::abs(worst - 1.0))) worst = length;  // NaN is worst
    bad.push_back(static_cast<std::int64_t>(e));
  }
  if (bad.empty()) return;
  SetupProblem p;
  p.kind = SetupErrorKind::bad_argument;
  p.what = std::to_string(bad.size()) + " elements have a fibre direction that is not a unit vector, worst length " +
           number(worst);
  p.hint = "Give a unit vector for every element, or for none";
  p.set_ids(bad, SetupIds::elements);
  p.value = worst;
  p.threshold = fibre_length_tolerance;
  raise(std::move(p));
}

/// Refuses as bad_argument fibre directions that are not unit vectors (zero and NaN included), with the ids of their
/// elements and the worst length, and a number of fibres that differs from the number of elements. O(elements); no cost
/// for a mesh without fibres.
template <MeshView M>
void require_unit_fibres(const M& mesh) {
  if constexpr (FibreMesh<M>) {
    if (!mesh.has_fibres()) return;
    if constexpr (requires { mesh.fibres.size(); }) require_fibre_count(mesh.fibres.size(), mesh.element_count());
    if constexpr (requires { std::span<const Vector3>(mesh.fibres); }) {
      require_unit_vectors(mesh.fibres);
    } else {
      std::vector<Vector3> fibres;
      for (Index e = 0; e < mesh.element_count(); ++e) fibres.emplace_back(mesh.fibre(e));
      require_unit_vectors(fibres);
    }
  }
}

}}}  // namespace palpate::detail
