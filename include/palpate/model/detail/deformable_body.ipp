// Definitions of deformable_body.hpp.
#pragma once

#include <palpate/model/detail/deformable_body.hpp>
#include <palpate/core/detail/box.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE double extent(const std::vector<Vector3>& positions) {
  return box_of(positions).size().norm();
}

PALPATE_INLINE void require_mass(const DeformableBody& body) {
  for (Index i = 0; i < body.lumped.size(); ++i)
    if (!(body.lumped[i] > 0.0) && body.conditions.constrained[static_cast<std::size_t>(i)] != 7)
      raise_at(SetupIds::nodes, i, SetupErrorKind::bad_density, "a node has no mass",
               "Give every region a density in kg/m^3");
}

}}  // namespace palpate

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void refuse_initial_strains(const Scene& scene) {
  if (!scene.initial_strains().empty())
    raise(SetupErrorKind::unsupported, "initial strains at large deformation or with viscoelasticity",
          "Use a linear material");
}

}}}  // namespace palpate::detail
