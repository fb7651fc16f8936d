// The materials at touched vertices.
#pragma once

#include <palpate/model/detail/half_space_source.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// The isotropic materials that stand for those of the elements at vertices, with the same bulk modulus and mean shear
/// stiffness. `material_of` has the elasticity matrix of every element. `ratios` receives their different Poisson
/// ratios; VertexMaterial::stiffness is an index of it. At a border the shear modulus is the mean, and the ratio that
/// of most elements; several_materials is set within two elements of it. O(elements near vertices).
std::vector<VertexMaterial> vertex_materials(const MeshRef& mesh, std::span<const NodeId> touched,
                                             const NodeElements& around, std::span<const Matrix6> elasticities,
                                             std::span<const int> material_of, std::vector<double>& ratios);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/vertex_materials.ipp>
#endif
