// What is needed of a body to project the compliance of a half-space on its mesh.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/contact/detail/projected_half_space.hpp>
#include <palpate/model/detail/boundary_nodes.hpp>
#include <palpate/model/detail/face_rules.hpp>

#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A stiffness of the whole body made of one isotropic material: as its elements have it, without supports.
struct UniformStiffness {
  const BlockMatrix* matrix = nullptr;
  double shear_modulus = 0.0, poisson_ratio = 0.0;  ///< [Pa], 1
};

/// The material at a touched vertex.
struct VertexMaterial {
  double shear_modulus = 0.0, poisson_ratio = 0.0;  ///< [Pa], 1
  int stiffness = 0;                                ///< the UniformStiffness with this Poisson ratio
  HalfSpaceMarks marks{};                           ///< several_materials, anisotropic
};

/// Parts of a body over which an element averages its change of volume, sum g_a . u_a, numbered by the node in their
/// middle. Empty for elements that do not.
struct VolumeDomains {
  NodeLists of_node;           ///< numbers of the domains around every node, one per region
  std::vector<double> volume;  ///< [m^3]
  std::vector<Index> first;    ///< of the nodes of every domain, one past the end last
  std::vector<NodeId> node;
  std::vector<Vector3> gradient;  ///< g [1/m]

  bool empty() const noexcept { return volume.empty(); }
};

/// Refers to its parts, which must outlive it.
struct HalfSpaceSource {
  MeshRef mesh;
  const NodeElements& around;
  const BoundaryNodes& boundary;
  const ElementFaceRules& rules;
  std::span<const NodeId> touched;            ///< node of every vertex, ascending
  std::span<const VertexMaterial> materials;  ///< of every vertex
  std::span<const std::uint8_t> constrained;  ///< per node, bit c set when component c is prescribed
  std::span<const UniformStiffness> stiffness;
  const VolumeDomains& domains;
  int layers = 3;  ///< elements of a patch, counted from its vertex

  Vector3 position(NodeId node) const noexcept { return boundary.position(node); }
};

}}  // namespace palpate
