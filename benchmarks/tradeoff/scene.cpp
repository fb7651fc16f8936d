#include "scene.hpp"

#include <palpate/contact/contact_surface.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/selection.hpp>

#include <Eigen/Geometry>

namespace tradeoff {
namespace {

ContactSurface surface_of(const Mesh<Tet4>& mesh) {
  std::vector<Triangle> triangles;
  for (const auto& t : boundary_triangles(mesh)) triangles.push_back({t[0], t[1], t[2]});
  return {mesh.positions, std::move(triangles)};
}

/// A sphere that moves along `towards` to `point`, at the position where it first touches the surface.
Sphere sphere_at(const ContactSurface& surface, const Vector3& point, const Vector3& towards, double radius) {
  Sphere sphere{.touching = Vector3::Zero(), .towards = towards.normalized(), .point = point};
  double in = 0.0, out = 3.0 * radius;
  for (int i = 0; i < 60; ++i) {
    const double middle = 0.5 * (in + out);
    (surface.closest(point - middle * sphere.towards).distance < radius ? in : out) = middle;
  }
  sphere.touching = point - out * sphere.towards;
  return sphere;
}

/// Mean outward normal of the triangles around a point, weighted by area.
Vector3 outward_at(const Mesh<Tet4>& mesh, const std::vector<std::array<NodeId, 3>>& triangles, const Vector3& point,
                   double within) {
  Vector3 sum = Vector3::Zero();
  for (const auto& t : triangles) {
    const Vector3 &a = mesh.position(t[0]), &b = mesh.position(t[1]), &c = mesh.position(t[2]);
    if (((a + b + c) / 3.0 - point).norm() < within) sum += (b - a).cross(c - a);
  }
  return sum.normalized();
}

NodeId nearest(const Mesh<Tet4>& mesh, const std::vector<NodeId>& nodes, const Vector3& to) {
  return *std::ranges::min_element(nodes, {}, [&](NodeId i) { return (mesh.position(i) - to).squaredNorm(); });
}

double mean_edge(const Mesh<Tet4>& mesh, const std::vector<BoundaryFace>& faces) {
  double sum = 0.0;
  for (const auto& f : faces)
    for (std::size_t i = 0; i < 3; ++i) sum += (mesh.position(f.nodes[i]) - mesh.position(f.nodes[(i + 1) % 3])).norm();
  return sum / (3.0 * static_cast<double>(faces.size()));
}

void add_faces(Mesh<Tet4>& mesh, const std::string& name, const std::vector<BoundaryFace>& faces) {
  Group& group = mesh.groups.get_or_add(name, 2);
  for (const auto& f : faces) {
    group.faces.push_back({f.nodes.begin(), f.nodes.end()});
    group.nodes.insert(group.nodes.end(), f.nodes.begin(), f.nodes.end());
  }
  mesh.groups.tidy();
}

/// A point of the surface `inward` [m] of the tip of the thin lobe, on its upper (+1) or lower (-1) side.
Vector3 lobe_point(const Mesh<Tet4>& mesh, const std::vector<NodeId>& surface, const ContactSurface& contact,
                   double inward, double side) {
  const NodeId tip = *std::ranges::max_element(surface, {}, [&](NodeId i) { return mesh.position(i).x(); });
  const Vector3 at = mesh.position(tip) - inward * Vector3::UnitX();
  return contact.closest(at + side * 0.05 * Vector3::UnitZ()).point;
}

std::vector<Sphere> make_spheres(const PressScene& scene, const std::string& kind, const std::vector<NodeId>& touched,
                                 const std::vector<NodeId>& surface) {
  const Mesh<Tet4>& mesh = scene.mesh;
  const ContactSurface contact = surface_of(mesh);
  if (kind == "retract")
    return {sphere_at(contact, lobe_point(mesh, surface, contact, 0.028, -1.0), Vector3::UnitZ(), scene.radius)};
  if (kind == "grasp")
    return {sphere_at(contact, lobe_point(mesh, surface, contact, 0.028, 1.0), -Vector3::UnitZ(), scene.radius),
            sphere_at(contact, lobe_point(mesh, surface, contact, 0.028, -1.0), Vector3::UnitZ(), scene.radius)};
  Vector3 middle = Vector3::Zero();
  for (const NodeId i : touched) middle += mesh.position(i) / static_cast<double>(touched.size());
  const Vector3 point = mesh.position(nearest(mesh, touched, middle));
  return {sphere_along_normal(mesh, point, scene.radius)};
}

/// Adds the groups of faces that a sphere may touch.
void add_touchable(PressScene& scene, const std::vector<BoundaryFace>& boundary,
                   const std::vector<BoundaryFace>& wide) {
  std::vector<BoundaryFace> near;
  for (const auto& f : boundary)
    if (std::ranges::any_of(scene.spheres, [&](const Sphere& b) {
          return std::ranges::any_of(f.nodes,
                                     [&](NodeId i) { return (scene.mesh.position(i) - b.point).norm() < scene.reach; });
        }))
      near.push_back(f);
  add_faces(scene.mesh, near_group, near);
  std::vector<BoundaryFace> both = near;
  both.insert(both.end(), wide.begin(), wide.end());
  std::ranges::sort(both, {}, [](const auto& f) { return f.key(); });
  both.erase(std::unique(both.begin(), both.end(), [](const auto& a, const auto& b) { return a.key() == b.key(); }),
             both.end());
  add_faces(scene.mesh, wide_group, both);
}

}  // namespace

std::vector<std::array<NodeId, 3>> boundary_triangles(const Mesh<Tet4>& mesh) {
  std::vector<std::array<NodeId, 3>> triangles;
  for (const auto& f : extract_boundary<Tet4>(mesh)) triangles.push_back({f.nodes[0], f.nodes[1], f.nodes[2]});
  return triangles;
}

Sphere sphere_along_normal(const Mesh<Tet4>& mesh, const Vector3& point, double radius) {
  return sphere_at(surface_of(mesh), point, -outward_at(mesh, boundary_triangles(mesh), point, radius), radius);
}

double volume_of(const Mesh<Tet4>& mesh, const std::vector<std::array<NodeId, 3>>& boundary, const VectorX& u) {
  const auto at = [&](NodeId i) -> Vector3 { return mesh.position(i) + u.segment<3>(3 * Index{i}); };
  double volume = 0.0;
  for (const auto& t : boundary) volume += at(t[0]).dot(at(t[1]).cross(at(t[2]))) / 6.0;
  return volume;
}

PressScene make_scene(const SceneOptions& options) {
  constexpr double organ_radius = 0.010;
  const bool organ = options.mesh.empty();
  Mesh<Tet4> mesh = io::read_mesh<Tet4>(organ ? PALPATE_BENCH_DATA "/organ.msh" : options.mesh);
  if (organ) return make_scene(std::move(mesh), {"ligament", "front", {}}, organ_radius, options);
  const Patches patches = choose_patches(mesh, extract_boundary<Tet4>(mesh), options.constrained, options.touched);
  return make_scene(std::move(mesh), patches, 0.0, options);
}

PressScene make_scene(Mesh<Tet4> mesh, const Patches& patches, double radius, const SceneOptions& options) {
  const bool organ = options.mesh.empty();
  PressScene scene;
  scene.name = options.kind;
  scene.mesh = std::move(mesh);
  const auto boundary = extract_boundary<Tet4>(scene.mesh);
  scene.remark = patches.remark;
  const Selection constrained = selection_of(patches.constrained, scene.mesh),
                  touched = selection_of(patches.touched, scene.mesh);
  const auto wide = detail::resolve_faces(
      scene.mesh, boundary, patches.constrained == patches.touched ? Selection(std::string(surface_group)) : touched);
  const auto touched_nodes = resolve_nodes(scene.mesh, boundary, touched);
  const auto constrained_nodes = resolve_nodes(scene.mesh, boundary, constrained);
  std::vector<BoundaryFace> constrained_faces;
  for (const auto& f : boundary)
    if (std::ranges::all_of(f.nodes, [&](NodeId i) { return std::ranges::binary_search(constrained_nodes, i); }))
      constrained_faces.push_back(f);

  const LinearElastic tissue{
      .youngs_modulus = options.youngs_modulus, .poisson_ratio = options.poisson_ratio, .density = options.density};
  for (const std::string& region : scene.mesh.region_names) {
    LinearElastic material = tissue;
    if (organ && region == "lesion" && options.kind == "palpate") material.youngs_modulus *= 10.0;
    scene.materials.push_back({region, material});
  }
  // The smallest sphere that the facets of this mesh resolve (docs/contact.md), pressed in by four fifths of its
  // radius.
  scene.radius = radius > 0.0 ? radius : 2.4 * mean_edge(scene.mesh, wide);
  scene.small = 0.1 * scene.radius;
  scene.large = 0.8 * scene.radius;
  if (options.kind == "retract") {
    scene.small = 0.2 * scene.radius;
    scene.large = 2.0 * scene.radius;
  } else if (options.kind == "grasp") {
    scene.large = 0.4 * scene.radius;
  }
  scene.reach = options.kind == "retract" ? 2.4 * scene.radius : 1.8 * scene.radius;
  scene.spheres = make_spheres(scene, options.kind, touched_nodes, nodes_of(boundary));
  scene.mesh.groups = {};
  if (constrained_faces.empty())
    scene.mesh.groups.get_or_add(constrained_group, 0).nodes = constrained_nodes;
  else
    add_faces(scene.mesh, constrained_group, constrained_faces);
  add_touchable(scene, boundary, wide);
  scene.mesh.groups.get_or_add(std::string(surface_group), 2);
  scene.mesh.groups.all().pop_back();  // its name stays defined without a group
  return scene;
}

}  // namespace tradeoff
