// Checks of fibre directions.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Allowed deviation of the length of a fibre direction from one: files print six digits or fewer. Materials normalise
/// it.
inline constexpr double fibre_length_tolerance = 1e-5;

namespace detail {

/// Refuses a number of fibres that differs from the number of elements.
void require_fibre_count(std::size_t fibres, Index element_count);
/// Refuses fibres that are not unit vectors.
void require_unit_vectors(std::span<const Vector3> fibres);

}  // namespace detail

/// Refuses as bad_argument fibre directions that are not unit vectors (zero and NaN included), with the ids of their
/// elements and the worst length, and a number of fibres that differs from the number of elements. O(elements); no cost
/// for a mesh without fibres.
template <MeshView M>
void require_unit_fibres(const M& mesh) {
  if constexpr (FibreMesh<M>) {
    if (!mesh.has_fibres()) return;
    if constexpr (requires { mesh.fibres.size(); })
      detail::require_fibre_count(mesh.fibres.size(), mesh.element_count());
    if constexpr (requires { std::span<const Vector3>(mesh.fibres); }) {
      detail::require_unit_vectors(mesh.fibres);
    } else {
      std::vector<Vector3> fibres;
      for (Index e = 0; e < mesh.element_count(); ++e) fibres.emplace_back(mesh.fibre(e));
      detail::require_unit_vectors(fibres);
    }
  }
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/fibres.ipp>
#endif
