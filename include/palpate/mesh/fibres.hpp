// Fibre directions that can be used.
#pragma once

#include <palpate/concepts/mesh.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// How far from one the length of a fibre direction may be: files print six digits or fewer. Laws use it normalised.
inline constexpr double fibre_length_tolerance = 1e-5;

/// Refuses fibre directions that are no unit vectors (zero and NaN among them) as bad_argument, with the ids of their
/// elements and the length that is farthest off; a number of fibres other than that of elements likewise. O(elements),
/// nothing for a mesh without fibres.
template <MeshView M>
void require_unit_fibres(const M& mesh) {
  if constexpr (FibreMesh<M>) {
    if (!mesh.has_fibres()) return;
    if constexpr (requires { mesh.fibres.size(); })
      if (static_cast<Index>(mesh.fibres.size()) != mesh.element_count())
        raise(SetupErrorKind::bad_argument, "the mesh has " + std::to_string(mesh.fibres.size()) + " fibre directions",
              "It needs one per element, " + std::to_string(mesh.element_count()) + ", or none");
    std::vector<std::int64_t> bad;
    double worst = 1.0;
    for (Index e = 0; e < mesh.element_count(); ++e) {
      const double length = Vector3(mesh.fibre(e)).norm();
      if (std::abs(length - 1.0) <= fibre_length_tolerance) continue;
      if (!(std::abs(length - 1.0) <= std::abs(worst - 1.0))) worst = length;  // NaN is worst
      bad.push_back(e);
    }
    if (bad.empty()) return;
    SetupProblem p;
    p.kind = SetupErrorKind::bad_argument;
    p.what = std::to_string(bad.size()) + " elements have a fibre direction that is no unit vector, worst length " +
             number(worst);
    p.hint = "Give every element a unit vector, or no element any";
    p.set_ids(bad);
    p.value = worst;
    p.threshold = fibre_length_tolerance;
    raise(std::move(p));
  }
}

}}  // namespace palpate
