// The laws of concepts/mesh.hpp.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/mesh.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/testing/face_laws.hpp>
#include <palpate/testing/quadrature_laws.hpp>
#include <palpate/testing/reference_cell.hpp>
#include <palpate/testing/violation.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

// Violations of a law are counted and one of them is described, so that a bad mesh of a million elements gives a short
// list.

std::string element_name(Index e);

/// "not empty", "indices in range", "nodes of an element differ", "region in range".
template <Element E, MeshOf<E> M>
Violations connectivity_laws(const M& mesh) {
  Violations v;
  const auto n = static_cast<Index>(mesh.node_count()), m = static_cast<Index>(mesh.element_count());
  expect_at_least(v, "not empty", static_cast<double>(std::min(n, m)), 1.0, "nodes or elements");
  Worst range("indices in range", 0.0), repeated("nodes of an element differ", 0.0), region("region in range", 0.0);
  for (Index e = 0; e < m; ++e) {
    const auto name = [e] { return element_name(e); };
    for (int a = 0; a < E::nodes; ++a) {
      const auto i = static_cast<Index>(mesh.element_node(e, a));
      range.observe(i < 0 || i >= n ? 1.0 : 0.0, [&] { return name() + " has node " + std::to_string(i); });
      for (int b = 0; b < a; ++b)
        repeated.observe(static_cast<Index>(mesh.element_node(e, b)) == i ? 1.0 : 0.0,
                         [&] { return name() + " has node " + std::to_string(i) + " twice"; });
    }
    const int r = static_cast<int>(mesh.region(e));
    region.observe(r < 0 || r >= static_cast<int>(mesh.region_count()) ? 1.0 : 0.0,
                   [&] { return name() + " is in region " + std::to_string(r); });
  }
  for (const Worst* law : {&range, &repeated, &region}) law->report(v);
  return v;
}

/// "positions finite", "no orphan nodes" (nodes that no element uses; models may drop them, but it is reported).
/// Indices must be in range.
template <Element E, MeshOf<E> M>
Violations node_laws(const M& mesh) {
  Violations v;
  const auto n = static_cast<Index>(mesh.node_count());
  std::vector<char> used(static_cast<std::size_t>(n), 0);
  for (Index e = 0; e < static_cast<Index>(mesh.element_count()); ++e)
    for (int a = 0; a < E::nodes; ++a) used[static_cast<std::size_t>(mesh.element_node(e, a))] = 1;
  Worst finite("positions finite", 0.0), orphan("no orphan nodes", 0.0);
  for (Index i = 0; i < n; ++i) {
    const auto name = [i] { return "node " + std::to_string(i); };
    finite.observe(mesh.position(i).allFinite() ? 0.0 : 1.0, name);
    orphan.observe(used[static_cast<std::size_t>(i)] != 0 ? 0.0 : 1.0, name);
  }
  finite.report(v);
  orphan.report(v);
  return v;
}

/// Coordinates of an element's nodes relative to its first one, divided by its size: independent of scale and of
/// distance to the origin.
template <Element E, MeshOf<E> M>
ElementNodes<E> normalised_nodes(const M& mesh, Index e) {
  ElementNodes<E> x = element_nodes<E>(mesh, e);
  const Eigen::RowVector3d first = x.row(0);
  x.rowwise() -= first;
  return x / x.rowwise().norm().maxCoeff();
}

/// "positive orientation": det dx/dxi > 0 at the rules' points, relative to the size of element and reference element
/// and above rounding. Slivers pass; flat and inverted elements do not.
template <Element E, MeshOf<E> M>
Violations orientation_laws(const M& mesh) {
  Violations v;
  constexpr double bound = 4 * std::numeric_limits<double>::epsilon();
  Index count = 0, worst_element = 0;
  double worst = infinity;
  for (Index e = 0; e < static_cast<Index>(mesh.element_count()); ++e) {
    const ElementNodes<E> x = normalised_nodes<E>(mesh, e);
    double smallest = infinity;
    const auto look = [&](const auto& points) {
      for (const auto& q : points) {
        const double det = Matrix3(x.transpose() * E::gradient(point_of(q.xi))).determinant() * E::reference_volume;
        if (!(det >= smallest)) smallest = det;
      }
    };
    look(E::Quadrature::points);
    look(E::MassQuadrature::points);
    if (smallest > bound) continue;
    ++count;
    if (smallest >= worst) continue;
    worst = smallest;
    worst_element = e;
  }
  if (count > 0)
    expect_above(v, "positive orientation", worst, bound,
                 element_name(worst_element) + ", " + std::to_string(count) + " in all");
  return v;
}

/// One face of one element with its area vector.
struct MeshFace {
  std::vector<Index> key;  ///< sorted nodes
  Index element = 0;
  Vector3 area = Vector3::Zero();
};

/// All faces of all elements, equal keys adjacent. Areas are taken relative to the first node of the mesh.
template <Element E, MeshOf<E> M>
std::vector<MeshFace> faces_with_areas(const M& mesh) {
  std::vector<MeshFace> faces;
  for (Index e = 0; e < static_cast<Index>(mesh.element_count()); ++e) {
    const ElementNodes<E> x = element_nodes<E>(mesh, e);
    for (std::size_t f = 0; f < E::faces.size(); ++f) {
      const auto local = palpate::detail::local_face<E>(f);
      MeshFace face;
      face.element = e;
      for (const int a : local) face.key.push_back(static_cast<Index>(mesh.element_node(e, a)));
      std::ranges::sort(face.key);
      palpate::detail::with_face_element<E>(local.size(), [&]<FaceElement F>() {
        FaceNodes<F> nodes;
        for (std::size_t a = 0; a < local.size(); ++a)
          nodes.row(static_cast<Eigen::Index>(a)) = x.row(local[a]) - x.row(0);
        face.area = area_vector<F>(nodes);
      });
      faces.push_back(std::move(face));
    }
  }
  std::ranges::sort(faces, [](const MeshFace& a, const MeshFace& b) { return a.key < b.key; });
  return faces;
}

/// "at most two elements share a face", "neighbours lie on opposite sides" of a shared face, "surface is closed": the
/// area vectors of the faces that belong to one element sum to zero.
template <Element E, MeshOf<E> M>
Violations surface_laws(const M& mesh) {
  Violations v;
  const auto faces = faces_with_areas<E>(mesh);
  Worst shared("at most two elements share a face", 2.0), opposite("neighbours lie on opposite sides", 1e-6);
  Vector3 sum = Vector3::Zero();
  double area = 0.0;
  for (std::size_t i = 0, j = 0; i < faces.size(); i = j) {
    while (j < faces.size() && faces[j].key == faces[i].key) ++j;
    const auto name = [&] { return element_name(faces[i].element); };
    shared.observe(static_cast<double>(j - i), name);
    if (j - i == 2) opposite.observe((faces[i].area + faces[i + 1].area).norm() / faces[i].area.norm(), name);
    if (j - i != 1) continue;
    sum += faces[i].area;
    area += faces[i].area.norm();
  }
  shared.report(v);
  opposite.report(v);
  expect_at_most(v, "surface is closed", sum.norm(), 1e-10 * area);
  return v;
}

/// All laws of a mesh of elements E. Laws that need valid indices or finite positions are skipped if these are
/// violated.
template <Element E, MeshOf<E> M>
Violations mesh_laws(const M& mesh) {
  Violations v = connectivity_laws<E>(mesh);
  if (violates(v, "indices in range") || violates(v, "not empty")) return v;
  append(v, node_laws<E>(mesh));
  if (violates(v, "positions finite")) return v;
  append(v, orientation_laws<E>(mesh));
  append(v, surface_laws<E>(mesh));
  return v;
}

inline std::string element_name(Index e) {
  return "element " + std::to_string(e);
}

}}}  // namespace palpate::testing
