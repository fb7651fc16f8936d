// The shipped organ, and the cuts that are made into it.
#pragma once

#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/contact/detail/blade_sweep.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/mesh/surface.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <ctime>
#include <utility>
#include <vector>

namespace cut_organ {

using namespace palpate;

inline Mesh<Tet4> organ_mesh() {
  return io::read_mesh<Tet4>(PALPATE_BENCH_DATA "/organ.msh");
}

// Middle and normal of the touchable patch.
inline const Vector3 middle(-0.0285, -0.0298, 0.0405), outward(0.076, -0.408, 0.910);
inline constexpr double smallest_tool = 4e-3;

/// Processor time of this thread [s].
inline double thread_seconds() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

/// The organ rests on its underside, as in example 01, and sags under its weight.
inline Scene organ_scene(const Mesh<Tet4>& mesh) {
  std::vector<NodeId> below;
  for (const auto& face : extract_boundary<Tet4>(mesh)) {
    const Vector3 a = mesh.position(face.nodes[0]), b = mesh.position(face.nodes[1]), c = mesh.position(face.nodes[2]);
    if ((b - a).cross(c - a).normalized().z() < -0.5) below.insert(below.end(), face.nodes.begin(), face.nodes.end());
  }
  return Scene().fix("ligament").fix(below).touch("front").gravity({0.0, 0.0, -9.81});
}
/// The present position of the surface next to the middle of the patch [m].
template <class Tissue>
Vector3 on_surface(const Tissue& tissue) {
  Vector3 best = Vector3::Constant(infinity);
  for (const Vector3& x : tissue.contact_surface().positions()) {
    const Vector3 p = tissue.to_world() * x;
    if ((p - middle).head<2>().norm() < (best - middle).head<2>().norm()) best = p;
  }
  return best;
}

/// The k-th of 120 parts of a slit, 40 mm long and 8 mm deep.
inline BladeSweep slit_part(int k) {
  const Vector3 from = middle + Vector3(-0.02 + 0.04 * k / 120.0, 0, 0), to = from + Vector3(0.04 / 120.0, 0, 0);
  return {from - 8e-3 * outward, from + 0.01 * outward, to - 8e-3 * outward, to + 0.01 * outward};
}
/// Elements near a line under the surface, along the line.
inline std::vector<Index> burnt_elements(const Mesh<Tet4>& mesh) {
  std::vector<std::pair<double, Index>> nearest;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const Vector3 x = element_nodes<Tet4>(mesh, e).colwise().mean().transpose() - middle;
    if (std::abs(x[0]) < 0.022 && (x - x[0] * Vector3::UnitX() + 3e-3 * outward).norm() < 6e-3)
      nearest.push_back({x[0], e});
  }
  std::ranges::sort(nearest);
  std::vector<Index> elements;
  for (const auto& [x, e] : nearest) elements.push_back(e);
  return elements;
}
/// The k-th of 120 parts of them.
inline CutOrder burning(const std::vector<Index>& elements, int k) {
  const auto part = [&](int i) { return elements.begin() + static_cast<std::ptrdiff_t>(elements.size()) * i / 120; };
  return {{part(k), part(k + 1)}, {}};
}

}  // namespace cut_organ
