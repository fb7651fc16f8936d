// Fibre directions that can be used.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How far from one the length of a fibre direction may be: files print six digits or fewer. Laws use it normalised.
inline constexpr double fibre_length_tolerance = 1e-5;

namespace detail {

/// Refuses a number of fibres other than that of elements.
void require_fibre_count(std::size_t fibres, Index element_count);
/// Refuses fibres that are no unit vectors.
void require_unit_vectors(std::span<const Vector3> fibres);

}  // namespace detail

/// Refuses fibre directions that are no unit vectors (zero and NaN among them) as bad_argument, with the ids of their
/// elements and the length that is farthest off; a number of fibres other than that of elements likewise. O(elements),
/// nothing for a mesh without fibres.
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
