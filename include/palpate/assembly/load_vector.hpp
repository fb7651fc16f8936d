// Nodal loads of a whole scene (thesis 3.38, 3.47; BCNaturlig, EksternLast, InitToyning).
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/integration_points.hpp>
#include <palpate/local/loads.hpp>
#include <palpate/local/strain_displacement.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Coordinates of a boundary face's nodes, one per row [m].
template <FaceElement F, Element E>
FaceNodes<F> face_nodes(const Mesh<E>& mesh, const BoundaryFace& face) {
  FaceNodes<F> x;
  for (int a = 0; a < F::nodes; ++a) {
    const Vector3 p = mesh.position(Index{face.nodes[static_cast<std::size_t>(a)]});
    for (int c = 0; c < 3; ++c) x.coeffRef(a, c) = p[c];
  }
  return x;
}

/// Integrals of shape functions over elements and faces, given by node ids, for code that is independent of the
/// element type. One number, or x y z, per node; `positions` stores x y z of every node of the mesh.
struct ShapeIntegrals {
  void (*volumes)(const double* positions, const NodeId* nodes, double* result) noexcept;
  void (*areas)(const double* positions, const BoundaryFace& face, double* result) noexcept;
  void (*area_vectors)(const double* positions, const BoundaryFace& face, double* result) noexcept;
};

template <int n>
Eigen::Matrix<double, n, 3> nodes_at(const double* positions, const NodeId* nodes) noexcept {
  Eigen::Matrix<double, n, 3> x;
  for (int a = 0; a < n; ++a)
    for (int c = 0; c < 3; ++c) x(a, c) = positions[3 * Index{nodes[a]} + c];
  return x;
}

template <Element E>
void volumes_of(const double* positions, const NodeId* nodes, double* result) noexcept {
  const auto v = shape_volumes<E>(nodes_at<E::nodes>(positions, nodes));
  for (int a = 0; a < E::nodes; ++a) result[a] = v[a];
}
template <Element E>
void areas_of(const double* positions, const BoundaryFace& face, double* result) noexcept {
  with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
    const auto areas = shape_areas<F>(nodes_at<F::nodes>(positions, face.nodes.begin()));
    for (int a = 0; a < F::nodes; ++a) result[a] = areas[a];
  });
}
template <Element E>
void area_vectors_of(const double* positions, const BoundaryFace& face, double* result) noexcept {
  with_face_element<E>(face.nodes.size(), [&]<FaceElement F>() {
    const auto areas = shape_area_vectors<F>(nodes_at<F::nodes>(positions, face.nodes.begin()));
    for (int a = 0; a < F::nodes; ++a)
      for (int c = 0; c < 3; ++c) result[3 * a + c] = areas(a, c);
  });
}

VectorX applied_load(const MeshRef& mesh, const ShapeIntegrals& integrals, const std::vector<BoundaryFace>& boundary,
                     const Scene& scene);
/// True if any strain is not zero.
bool any_strain(const std::vector<Vector6>& strains) noexcept;
VectorX nodal_mass(const MeshRef& mesh, const ShapeIntegrals& integrals, const std::vector<double>& density);

template <Element E>
inline constexpr ShapeIntegrals shape_integrals{&volumes_of<E>, &areas_of<E>, &area_vectors_of<E>};

}  // namespace detail

/// Mass per node [kg] by row sums: the consistent load of a uniform acceleration g is mass times g (3.44). One entry
/// per node.
template <Element E>
VectorX nodal_mass(const Body<E>& body) {
  return detail::nodal_mass(mesh_ref(body.mesh), detail::shape_integrals<E>, body.density);
}

namespace detail {

/// Tractions, pressures, point loads and body loads of a scene, without gravity: 3 entries per node [N]. Throws
/// unknown_group, empty_group or unsupported (a load on an inner face).
template <Element E>
VectorX applied_load(const Body<E>& body, const std::vector<BoundaryFace>& boundary, const Scene& scene) {
  return applied_load(mesh_ref(body.mesh), shape_integrals<E>, boundary, scene);
}

/// Load f_0 of initial strains per region, those of the body if none are given (3.28, 3.45): 3 entries per node [N].
template <Element E>
VectorX initial_strain_load(const Body<E>& body, const std::vector<Vector6>& strains) {
  VectorX f = VectorX::Zero(3 * body.mesh.node_count());
  if (!any_strain(strains)) return f;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const auto fe =
        initial_strain_load<E>(element_nodes<E>(body.mesh, e), body.elasticity_of(e), strains[body.region_of(e)]);
    for (int a = 0; a < E::nodes; ++a)
      for (int c = 0; c < 3; ++c) f[3 * Index{body.mesh.element_node(e, a)} + c] += fe(a, c);
  }
  return f;
}

template <Element E>
VectorX initial_strain_load(const Body<E>& body) {
  return initial_strain_load(body, body.initial_strain);
}

/// Initial strain per region of a scene; several on one region are added. Throws unknown_group.
std::vector<Vector6> initial_strains_by_region(const MeshRef& mesh, const Scene& scene);
template <Element E>
std::vector<Vector6> initial_strains_by_region(const Mesh<E>& mesh, const Scene& scene) {
  return initial_strains_by_region(mesh_ref(mesh), scene);
}

}  // namespace detail

/// Stored energy [J]: 1/2 sum_q (epsilon - epsilon_0) : D : (epsilon - epsilon_0) dV for nodal displacements u (3
/// entries per node [m]).
template <Element E>
double strain_energy(const Body<E>& body, const VectorX& u) {
  double energy = 0.0;
  for (Index e = 0; e < body.mesh.element_count(); ++e) {
    const ElementNodes<E> x = element_nodes<E>(body.mesh, e);
    ElementNodes<E> ue;
    for (int a = 0; a < E::nodes; ++a)
      for (int c = 0; c < 3; ++c) ue(a, c) = u[3 * Index{body.mesh.element_node(e, a)} + c];
    for (const detail::IntegrationPoint<E>& point : detail::integration_points<E>(x)) {
      const Vector6 elastic = detail::strain_at<E>(point, ue) - body.initial_strain[body.region_of(e)];
      energy += 0.5 * point.volume * elastic.dot(body.elasticity_of(e) * elastic);
    }
  }
  return energy;
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/assembly/load_vector.ipp>
#endif
