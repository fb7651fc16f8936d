// Definitions of load_vector.hpp.
#pragma once

#include <palpate/assembly/load_vector.hpp>
#include <palpate/mesh/selection.hpp>

#include <algorithm>
#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

inline void add_face_loads(const MeshRef& mesh, const ShapeIntegrals& integrals,
                           const std::vector<BoundaryFace>& boundary, const Scene& scene, VectorX& f) {
  std::array<double, 3 * max_face_nodes> parts;
  for (const auto& load : scene.tractions())
    for (const auto& face : resolve_faces(mesh, boundary, load.where)) {
      integrals.areas(mesh.positions, face, parts.data());
      for (std::size_t a = 0; a < face.nodes.size(); ++a) add_node_vector(f, face.nodes[a], parts[a] * load.traction);
    }
  for (const auto& load : scene.pressures())
    for (const auto& face : resolve_faces(mesh, boundary, load.where)) {
      integrals.area_vectors(mesh.positions, face, parts.data());
      for (std::size_t a = 0; a < face.nodes.size(); ++a)
        add_node_vector(f, face.nodes[a], -load.pressure * Vector3(parts[3 * a], parts[3 * a + 1], parts[3 * a + 2]));
    }
}

PALPATE_INLINE VectorX applied_load(const MeshRef& mesh, const ShapeIntegrals& integrals,
                                    const std::vector<BoundaryFace>& boundary, const Scene& scene) {
  VectorX f = VectorX::Zero(3 * mesh.node_count);
  add_face_loads(mesh, integrals, boundary, scene, f);
  for (const auto& load : scene.point_loads()) {
    const auto nodes = resolve_nodes(mesh, boundary, load.where);
    for (NodeId node : nodes) add_node_vector(f, node, load.force / static_cast<double>(nodes.size()));
  }
  std::vector<double> volumes(static_cast<std::size_t>(mesh.element.nodes));
  for (const auto& load : scene.body_loads()) {
    require_region(mesh, load.region);
    for (Index e = 0; e < mesh.element_count; ++e) {
      if (load.region != everywhere && mesh.region_names[static_cast<std::size_t>(mesh.region(e))] != load.region)
        continue;
      integrals.volumes(mesh.positions, mesh.nodes_of(e), volumes.data());
      for (std::size_t a = 0; a < volumes.size(); ++a)
        add_node_vector(f, mesh.nodes_of(e)[a], volumes[a] * load.force_per_volume);
    }
  }
  return f;
}

PALPATE_INLINE VectorX nodal_mass(const MeshRef& mesh, const ShapeIntegrals& integrals,
                                  const std::vector<double>& density) {
  VectorX mass = VectorX::Zero(mesh.node_count);
  std::vector<double> volumes(static_cast<std::size_t>(mesh.element.nodes));
  for (Index e = 0; e < mesh.element_count; ++e) {
    integrals.volumes(mesh.positions, mesh.nodes_of(e), volumes.data());
    const double rho = density[static_cast<std::size_t>(mesh.region(e))];
    for (std::size_t a = 0; a < volumes.size(); ++a) mass[mesh.nodes_of(e)[a]] += rho * volumes[a];
  }
  return mass;
}

PALPATE_INLINE bool any_strain(const std::vector<Vector6>& strains) noexcept {
  return !std::ranges::all_of(strains, [](const Vector6& s) { return s.isZero(0.0); });
}

PALPATE_INLINE std::vector<Vector6> initial_strains_by_region(const MeshRef& mesh, const Scene& scene) {
  std::vector<Vector6> strains(mesh.region_names.size(), Vector6::Zero());
  for (const auto& s : scene.initial_strains()) {
    require_region(mesh, s.region);
    for (std::size_t r = 0; r < strains.size(); ++r)
      if (s.region == everywhere || mesh.region_names[r] == s.region) strains[r] += s.strain;
  }
  return strains;
}

}}}  // namespace palpate::detail
