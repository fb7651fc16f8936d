// The table of what a mesh makes of the compliance of a half-space.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/local/isotropic.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/detail/half_space_source.hpp>

#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The isotropic materials that stand for those of the elements at vertices, with the same bulk modulus and mean shear
/// stiffness. `material_of` has the elasticity matrix of every element. `ratios` receives their different Poisson
/// ratios; VertexMaterial::stiffness is an index of it. At a border the shear modulus is the mean, and the ratio that
/// of most elements; several_materials is set within two elements of it, or the longest edge. O(elements near
/// vertices).
std::vector<VertexMaterial> vertex_materials(const MeshRef& mesh, std::span<const NodeId> touched,
                                             const NodeElements& around, std::span<const Matrix6> elasticities,
                                             std::span<const int> material_of, std::vector<double>& ratios);

/// Computes the table for all vertices of a source. Vertices are divided among the threads of `limits`; the result has
/// the same bits for any number of them. Throws too_large or cancelled, and bad_argument where lists of the source do
/// not have its size. Allocates; 0.2 to 0.4 ms per vertex and core for linear elements, 1 ms for quadratic ones, and 2
/// kB per vertex; each thread has 28 bytes per node of the mesh.
ProjectedHalfSpace project_half_space(const HalfSpaceSource& source, const SetupLimits& limits);

/// The domains of an element with smoothed strain; none for others. O(elements), throws as StrainDomains.
template <Element E>
VolumeDomains volume_domains([[maybe_unused]] const Body<E>& body, [[maybe_unused]] const NodeElements& around,
                             [[maybe_unused]] const SetupLimits& limits) {
  VolumeDomains result;
  if constexpr (HasSmoothedStrain<E>) {
    std::vector<NodeId> middle;
    const StrainDomains<E> domains(body.mesh, around, limits);
    result.first.push_back(0);
    for (Index d = 0; d < domains.size(); ++d) {
      const StrainDomain domain = domains[d];
      if (domain.part != StrainPart::volumetric) continue;
      middle.push_back(domain.ends[1]);
      result.volume.push_back(domain.volume);
      result.node.insert(result.node.end(), domain.nodes.begin(), domain.nodes.end());
      result.gradient.insert(result.gradient.end(), domain.gradients.begin(), domain.gradients.end());
      result.first.push_back(static_cast<Index>(result.node.size()));
    }
    result.of_node = NodeLists(static_cast<Index>(middle.size()), body.mesh.node_count(),
                               [&](Index d) { return std::span(&middle[static_cast<std::size_t>(d)], 1); });
  }
  return result;
}

/// The table of a body with its own elements, whatever its solver. `boundary` are its boundary faces, `touched` the
/// ascending nodes of its vertices, `constrained` the prescribed components per node. `own` is the assembled stiffness
/// of the body, or null; it is used where the body is of one isotropic material, and others are assembled. Throws as
/// project_half_space and assemble_stiffness.
template <Element E>
ProjectedHalfSpace project_half_space(const Body<E>& body, const std::vector<BoundaryFace>& boundary,
                                      std::span<const NodeId> touched, std::span<const std::uint8_t> constrained,
                                      const BlockMatrix* own, const SetupLimits& limits) {
  if (touched.empty()) return {};
  const NodeElements around(body.mesh);
  std::vector<int> material_of;
  for (Index e = 0; e < body.mesh.element_count(); ++e) material_of.push_back(static_cast<int>(body.material_of(e)));
  std::vector<double> ratios;
  const auto materials = vertex_materials(mesh_ref(body.mesh), touched, around, body.elasticity, material_of, ratios);
  const bool one = own != nullptr && body.elasticity.size() == 1 && lame_constants(body.elasticity[0]);
  std::vector<BlockMatrix> made(one ? 0 : ratios.size());
  std::vector<UniformStiffness> stiffness;
  if (one) stiffness.push_back({own, equivalent_shear_modulus(body.elasticity[0]), ratios.at(0)});
  for (std::size_t i = 0; i < made.size(); ++i) {
    made[i] = assemble_stiffness<E>(make_body(body.mesh, LinearElastic{2.0 * (1.0 + ratios[i]), ratios[i]}), limits);
    stiffness.push_back({&made[i], 1.0, ratios[i]});
  }
  const BoundaryNodes nodes(mesh_ref(body.mesh), boundary);
  const ElementFaceRules rules = element_face_rules<E>();
  const VolumeDomains domains = volume_domains(body, around, limits);
  return project_half_space(HalfSpaceSource{mesh_ref(body.mesh), around, nodes, rules, touched, materials, constrained,
                                            stiffness, domains, E::order > 1 ? 2 : 3},
                            limits);
}

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/project_half_space.ipp>
#endif
