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

PALPATE_INLINE std::vector<Index> leave_mass(DeformableBody& body, const VectorX& nodal_mass, const VectorX& u) {
  EssentialConditions& c = body.conditions;
  std::vector<Index> bare;
  for (Index dof = 0; dof < u.size(); ++dof) {
    if (nodal_mass[dof / 3] > 0.0 || !(body.lumped[dof / 3] > 0.0)) continue;
    c.prescribed[dof] = u[dof];
    if (c.free_index[static_cast<std::size_t>(dof)] >= 0) bare.push_back(dof);
    c.free_index[static_cast<std::size_t>(dof)] = -1;
    c.constrained[static_cast<std::size_t>(dof / 3)] = 7;
  }
  std::erase_if(c.free_dofs, [&c](Index dof) { return c.is_constrained(dof); });
  for (std::size_t i = 0; i < c.free_dofs.size(); ++i)
    c.free_index[static_cast<std::size_t>(c.free_dofs[i])] = static_cast<Index>(i);
  body.lumped = nodal_mass;
  return bare;
}

}}}  // namespace palpate::detail
