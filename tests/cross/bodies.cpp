// Mesh and conditions of a scene, and the places on its surface.
#include "built.hpp"

#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/testing/random.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>
#include <stdexcept>
#include <type_traits>

namespace cross {

using palpate::Hex8;
using palpate::Index;
using palpate::NodeId;
using palpate::Tet4;
using palpate::testing::Random;

namespace {

constexpr double pi = std::numbers::pi;
/// Of the height of a round body, in radii about its middle.
constexpr double round_support = -0.4, round_touchable = -0.2;
constexpr double least_quality = 0.05, sliver_quality = 0.035;

bool is_flat(const Scene& scene) {
  return scene.body == "block" || scene.body == "plate" || scene.body == "lobe";
}

/// Of the reference shape: a box with its middle above the origin and its lower side at z = 0, or a sphere around the
/// origin [m].
Vector3 reference_extent(const Scene& s) {
  if (is_round(s)) return Vector3::Constant(2.0 * s.edge * s.cells_x);
  return s.edge * Vector3(s.cells_x, s.cells_y, s.cells_z);
}
Vector3 reference_middle(const Scene& s) {
  return is_round(s) ? Vector3(Vector3::Zero()) : Vector3(0.0, 0.0, 0.5 * s.edge * s.cells_z);
}

/// From the reference shape to that of the body.
class BodyMap {
 public:
  explicit BodyMap(const Scene& scene) : scene_(scene), extent_(reference_extent(scene)) {}

  Vector3 operator()(const Vector3& q) const {
    if (scene_.body == "dome") return dome(q);
    if (scene_.body == "tube") return tube(q);
    if (scene_.body == "organ") return organ(q);
    return q;
  }

  Matrix3 jacobian(const Vector3& q) const {
    if (is_flat(scene_)) return Matrix3::Identity();
    const double step = 1e-5 * extent_.maxCoeff();
    Matrix3 derivative;
    for (int axis = 0; axis < 3; ++axis) {
      const Vector3 move = step * Vector3::Unit(axis);
      derivative.col(axis) = ((*this)(q + move) - (*this)(q - move)) / (2.0 * step);
    }
    return derivative;
  }

 private:
  /// Over a cap of a sphere; the wall is never thicker than half of its radius.
  Vector3 dome(const Vector3& q) const {
    const double radius = std::max({extent_[0], extent_[1], 2.0 * extent_[2]}), inner = radius - extent_[2];
    const Vector3 direction = Vector3(std::tan(q[0] / radius), std::tan(q[1] / radius), 1.0).normalized();
    return (inner + q[2]) * direction - inner * Vector3::UnitZ();
  }
  /// Around the y axis; the wall is never thicker than two thirds of its mean radius.
  Vector3 tube(const Vector3& q) const {
    const double mean = std::max(extent_[0] / pi, 1.5 * extent_[2]);
    const double angle = q[0] / mean, radius = mean + q[2] - 0.5 * extent_[2];
    return {radius * std::sin(angle), q[1], radius * std::cos(angle)};
  }
  /// An ellipsoid with a bulge. The least stretch is 0.8, and the derivative of the bulge at most 0.35: never inverted.
  Vector3 organ(const Vector3& q) const {
    const double radius = 0.5 * extent_[0];
    const Vector3 s = q / radius;
    const double bulge = 0.2 * std::exp(-4.0 * (s - Vector3(0.5, 0.3, 0.6)).squaredNorm());
    return radius * (Vector3(1.3 * s[0], s[1], 0.8 * s[2]) + bulge * Vector3(0.3, 0.2, 1.0).normalized());
  }

  const Scene& scene_;
  Vector3 extent_;
};

std::vector<std::size_t> shuffled(std::size_t count, Random& random) {
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  for (std::size_t i = count; i > 1; --i) std::swap(order[i - 1], order[random.bits() % i]);
  return order;
}

template <class T>
std::vector<T> in_order(const std::vector<T>& values, const std::vector<std::size_t>& order) {
  std::vector<T> result;
  result.reserve(order.size());
  for (std::size_t i : order) result.push_back(values[i]);
  return result;
}

void tidy(palpate::Group& group) {
  std::ranges::sort(group.nodes);
  group.nodes.erase(std::unique(group.nodes.begin(), group.nodes.end()), group.nodes.end());
}

/// The mesh of a body, before and after its change.
template <class E>
class BodyMesh {
 public:
  BodyMesh(const Scene& scene, const Change& change) : scene_(scene), map_(scene) {
    make_grid();
    choose_groups();
    divide(change.split);
    move_nodes();
    top_node = nearest_touchable(place_of(scene, 0.5, 0.5, false).point);
    apply(change);
  }

  palpate::Mesh<E> mesh;
  std::string division;  ///< Body::division
  double size = 0.0;     ///< largest extent before the change [m]
  NodeId top_node = 0;   ///< the touchable node that is the nearest to the middle of the top

 private:
  void make_grid() {
    const Vector3 extent = reference_extent(scene_);
    const std::array<int, 3> cells{scene_.cells_x, scene_.cells_y, scene_.cells_z};
    const Vector3 origin(-0.5 * extent[0], -0.5 * extent[1], 0.0);
    if constexpr (std::is_same_v<E, Hex8>) {
      if (is_round(scene_)) throw std::runtime_error("a " + scene_.body + " cannot be made of hexahedra");
      mesh = palpate::box_hex8(extent, cells, origin);
    } else {
      mesh = is_round(scene_) ? palpate::sphere_tet4(0.5 * extent[0], scene_.cells_x)
                              : palpate::box_tet4(extent, cells, palpate::BoxSplit::five_mirrored, origin);
    }
    reference_ = mesh.positions;
    boundary_ = palpate::extract_boundary<E>(mesh);
    around_.resize(mesh.positions.size());
    for (std::size_t e = 0; e < mesh.elements.size(); ++e)
      for (NodeId node : mesh.elements[e]) around_[static_cast<std::size_t>(node)].push_back(static_cast<Index>(e));
    inner_.assign(mesh.positions.size(), 1);
    for (NodeId node : palpate::nodes_of(boundary_)) inner_[static_cast<std::size_t>(node)] = 0;
  }

  double height(NodeId node) const { return reference_[static_cast<std::size_t>(node)][2]; }

  /// Faces and nodes of some sides of the grid; of a round body those below the height of its support.
  palpate::Group part(const std::string& name, const std::vector<std::string>& sides) const {
    palpate::Group group{name, 2, {}, {}, {}};
    for (const std::string& side : sides) {
      if (is_round(scene_)) break;
      const palpate::Group& one = *mesh.groups.find(side);
      group.nodes.insert(group.nodes.end(), one.nodes.begin(), one.nodes.end());
      group.faces.insert(group.faces.end(), one.faces.begin(), one.faces.end());
    }
    if (is_round(scene_)) {
      const auto low = [&](NodeId node) { return height(node) < round_support * scene_.edge * scene_.cells_x; };
      for (NodeId node : palpate::nodes_of(boundary_))
        if (low(node)) group.nodes.push_back(node);
      add_faces(group, [&](const auto& face) { return std::ranges::all_of(face.nodes, low); });
    }
    tidy(group);
    return group;
  }

  template <class Choose>
  void add_faces(palpate::Group& group, Choose&& choose) const {
    for (const palpate::BoundaryFace& face : boundary_)
      if (choose(face)) group.faces.emplace_back(face.nodes.begin(), face.nodes.end());
  }

  palpate::Group touchable(const palpate::Group& support) const {
    palpate::Group group{"touchable", 2, {}, {}, {}};
    const auto supported = [&](NodeId node) { return std::ranges::binary_search(support.nodes, node); };
    const auto high = [&](NodeId node) { return height(node) > round_touchable * scene_.edge * scene_.cells_x; };
    if (scene_.touched == "whole")
      add_faces(group, [](const auto&) { return true; });
    else if (scene_.touched == "surface")
      add_faces(group, [&](const auto& face) { return !std::ranges::all_of(face.nodes, supported); });
    else if (is_round(scene_))
      add_faces(group, [&](const auto& face) { return std::ranges::all_of(face.nodes, high); });
    else
      group.faces = mesh.groups.find("z1")->faces;
    for (const auto& face : group.faces) group.nodes.insert(group.nodes.end(), face.begin(), face.end());
    tidy(group);
    return group;
  }

  void choose_groups() {
    using Sides = std::vector<std::string>;
    const Sides sides = scene_.support == "bottom"  ? Sides{"z0"}
                        : scene_.support == "sides" ? Sides{"x0", "x1"}
                                                    : Sides{"x0"};
    const palpate::Group support = part("support", sides), end = part("end", {"x0"}), far = part("far", {"x1"});
    const palpate::Group touched = touchable(support);
    mesh.groups = {};
    mesh.groups.all() = {support, end, touched};
    if (scene_.support_travels != 0.0) mesh.groups.all().push_back(far);
  }

  /// Vector from the middle of the reference shape to the centre of an element there.
  Vector3 from_middle(std::size_t e) const {
    Vector3 centre = Vector3::Zero();
    for (NodeId node : mesh.elements[e]) centre += reference_[static_cast<std::size_t>(node)];
    return centre / E::nodes - reference_middle(scene_);
  }

  /// Region 1 where `second` accepts the centre of an element; false if one of the regions would be empty.
  template <class Second>
  bool divide_by(Second&& second) {
    mesh.regions.resize(mesh.elements.size());
    for (std::size_t e = 0; e < mesh.elements.size(); ++e) mesh.regions[e] = second(from_middle(e)) ? 1 : 0;
    const auto count = static_cast<std::size_t>(std::ranges::count(mesh.regions, 1));
    return count > 0 && count < mesh.elements.size();
  }

  /// A division that leaves a region empty, such as one layer of cells in two, is replaced by that across x, and if
  /// this one does too, by none.
  void divide(bool split) {
    const double extent = reference_extent(scene_).maxCoeff(), margin = 1e-9 * extent;  // of centres in the middle
    const auto low = [&](const Vector3& c) { return c[2] < -margin; };
    const auto far = [&](const Vector3& c) { return c[0] > margin; };
    const auto inside = [&](const Vector3& c) { return c.norm() < 0.25 * extent; };
    division = "one";
    if (scene_.regions == "layer" && divide_by(low)) division = "layer";
    if (scene_.regions == "inclusion" && divide_by(inside)) division = "inclusion";
    if (division == "one" && (split || scene_.regions != "one") && divide_by(far)) division = "half";
    mesh.region_names = {"first"};
    if (division != "one")
      mesh.region_names.emplace_back("second");
    else
      mesh.regions.assign(mesh.elements.size(), 0);
  }

  /// Least quality of the elements at a node.
  double quality_at(std::size_t node) const {
    double least = 1.0;
    for (Index e : around_[node])
      least = std::min(least, palpate::element_shape<E>(palpate::element_nodes<E>(mesh, e)).quality);
    return least;
  }

  void move_nodes() {
    for (Vector3& x : mesh.positions) x = map_(x);
    Vector3 low = mesh.positions[0], high = low;
    for (const Vector3& x : mesh.positions) low = low.cwiseMin(x), high = high.cwiseMax(x);
    size = (high - low).maxCoeff();
    if (scene_.jitter > 0.0) add_jitter();
    if constexpr (std::is_same_v<E, Tet4>) add_slivers();
  }

  void add_jitter() {
    Random random(scene_.seed);
    for (std::size_t node = 0; node < inner_.size(); ++node) {
      if (!inner_[node]) continue;
      const Vector3 before = mesh.positions[node];
      Vector3 shift = scene_.jitter * scene_.edge * random.vector<3>(-1.0, 1.0);
      for (int attempt = 0; attempt < 12; ++attempt, shift *= 0.5) {
        mesh.positions[node] = before + shift;
        if (quality_at(node) >= least_quality) break;
        mesh.positions[node] = before;
      }
    }
  }

  void add_slivers() {
    Random random(scene_.seed + 0x5eed);  // another sequence than that of the jitter, so that each can change alone
    int made = 0;
    for (std::size_t node : shuffled(inner_.size(), random))
      if (made < scene_.slivers && inner_[node] && flatten(node, random)) ++made;
  }

  /// Moves a node towards the opposite face of one of its elements until the worst of them is almost flat.
  bool flatten(std::size_t node, Random& random) {
    if (quality_at(node) < 2.0 * sliver_quality) return false;
    const auto e = static_cast<std::size_t>(around_[node][random.bits() % around_[node].size()]);
    const Vector3 start = mesh.positions[node];
    Vector3 target = -start / 3.0;
    for (NodeId other : mesh.elements[e]) target += mesh.positions[static_cast<std::size_t>(other)] / 3.0;
    double low = 0.0, high = 1.0;
    for (int step = 0; step < 50; ++step) {
      const double middle = 0.5 * (low + high);
      mesh.positions[node] = start + middle * (target - start);
      (quality_at(node) > sliver_quality ? low : high) = middle;
    }
    mesh.positions[node] = start + low * (target - start);
    return true;
  }

  NodeId nearest_touchable(const Vector3& point) const {
    const auto distance = [&](NodeId node) {
      return (mesh.positions[static_cast<std::size_t>(node)] - point).squaredNorm();
    };
    return *std::ranges::min_element(mesh.groups.find("touchable")->nodes, {}, distance);
  }

  void apply(const Change& change) {
    for (Vector3& x : mesh.positions) x = change(x);
    if (change.linear.determinant() < 0.0) reorient();
    if (change.renumbered) renumber();
  }

  /// Makes the volumes positive and the faces outward again after a reflection.
  void reorient() {
    for (auto& element : mesh.elements)
      if constexpr (std::is_same_v<E, Hex8>)
        std::rotate(element.begin(), element.begin() + 4, element.end());
      else
        std::swap(element[2], element[3]);
    for (palpate::Group& group : mesh.groups.all())
      for (auto& face : group.faces) std::ranges::reverse(face);
  }

  void renumber() {
    Random random(56);
    const std::vector<std::size_t> nodes = shuffled(mesh.positions.size(), random);
    const std::vector<std::size_t> elements = shuffled(mesh.elements.size(), random);
    std::vector<NodeId> place(nodes.size());
    for (std::size_t i = 0; i < nodes.size(); ++i) place[nodes[i]] = static_cast<NodeId>(i);
    const auto rename = [&](NodeId& node) { node = place[static_cast<std::size_t>(node)]; };
    mesh.positions = in_order(mesh.positions, nodes);
    mesh.elements = in_order(mesh.elements, elements);
    mesh.regions = in_order(mesh.regions, elements);
    for (auto& element : mesh.elements) std::ranges::for_each(element, rename);
    for (palpate::Group& group : mesh.groups.all()) {
      std::ranges::for_each(group.nodes, rename);
      for (auto& face : group.faces) std::ranges::for_each(face, rename);
      tidy(group);
    }
    rename(top_node);
  }

  const Scene& scene_;
  BodyMap map_;
  std::vector<Vector3> reference_;  // positions before the map
  std::vector<palpate::BoundaryFace> boundary_;
  std::vector<std::vector<Index>> around_;  // elements at every node
  std::vector<char> inner_;
};

/// `size` before the change.
void add_load(palpate::Scene& conditions, const Scene& s, const Change& change, double size, NodeId top_node) {
  const double stress = s.youngs_modulus * s.load_size, scale = change.scale;
  const Vector3 down = change.direction(-Vector3::UnitZ()), along = change.direction(Vector3::UnitX());
  if (s.load == "gravity") conditions.gravity(scale * stress / (s.density * size) * down);
  if (s.load == "pressure") conditions.pressure("touchable", stress);
  if (s.load == "traction") conditions.traction("touchable", 0.3 * stress * along);
  if (s.load == "body" && change.gravity) conditions.gravity(scale * stress / (s.density * size) * along);
  if (s.load == "body" && !change.gravity) conditions.body_load(palpate::everywhere, stress / (size * scale) * along);
  if (s.load == "point")
    conditions.point_load(std::vector<NodeId>{top_node}, scale * scale * stress * s.edge * s.edge * down);
  if (s.load == "swelling") conditions.expand(palpate::everywhere, s.load_size);
}

/// Of the touchable part: the radius of the smallest tool is given only where errors are measured.
palpate::TouchOptions touch_options(const Scene& scene, const Change& change) {
  if (!scene.measured && !scene.corrected) return {};
  double smallest = scene.tools[0].radius;
  for (const ToolValue& tool : scene.tools) smallest = std::min(smallest, tool.radius);
  return {change.scale * smallest, scene.tools.size() > 1 && has_opposite(scene)};
}

/// `travel`: of a moving support, a part of Scene::support_travels.
palpate::Scene make_conditions(const Scene& scene, const Change& change, double size, NodeId top_node,
                               double travel = 0.0) {
  palpate::Scene conditions;
  if (scene.support_travels != 0.0) {
    const double length = scene.edge * scene.cells_x;
    const Vector3 move = change.scale * travel * scene.support_travels * length * change.direction(Vector3::UnitX());
    conditions.fix("end").prescribe("far", {move[0], move[1], move[2]});
  } else if (scene.support_moves != 0.0) {
    const Vector3 move = change.scale * scene.support_moves * scene.edge * change.direction(Vector3::UnitX());
    conditions.prescribe("support", {move[0], move[1], move[2]});
  } else {
    conditions.fix("support");
  }
  conditions.touch("touchable", touch_options(scene, change));
  add_load(conditions, scene, change, size, top_node);
  return conditions;
}

template <class E>
void build(const Scene& scene, const Change& change, Body& body, palpate::Mesh<E>& mesh) {
  BodyMesh<E> made(scene, change);
  body.conditions = make_conditions(scene, change, made.size, made.top_node);
  if (scene.support_travels != 0.0)
    body.conditions_at = [scene, change, size = made.size, node = made.top_node](double part) {
      return make_conditions(scene, change, size, node, part);
    };
  body.moduli = {scene.youngs_modulus};
  body.division = made.division;
  if (body.division != "one")
    body.moduli.push_back(scene.youngs_modulus * (scene.regions == "one" ? 1.0 : scene.contrast));
  body.density = scene.density / (change.scale * change.scale);
  body.size = change.scale * made.size;
  mesh = std::move(made.mesh);
}

/// A point of the reference shape, its outward normal and a tangent.
Place box_place(const Scene& scene, double u, double v, bool opposite) {
  const Vector3 extent = reference_extent(scene);
  const auto inside = [](double part) { return 0.8 * (part - 0.5); };  // edges are avoided
  const double z = opposite ? 0.0 : extent[2];
  return {Vector3(extent[0] * inside(u), extent[1] * inside(v), z),
          opposite ? Vector3(-Vector3::UnitZ()) : Vector3(Vector3::UnitZ()), Vector3::UnitX()};
}

/// Height above which every place is on a touchable face, in radii: a face is about as high as a layer is thick.
double lowest_place(const Scene& scene) {
  if (scene.touched != "top") return -0.3;
  return std::min(0.6, round_touchable + 1.1 / scene.cells_x);
}

Place round_place(const Scene& scene, double u, double v, bool opposite) {
  const double lowest = lowest_place(scene), edge = std::min(0.31 * pi, std::acos(std::sqrt(std::max(0.1, lowest))));
  const double a = 2.0 * edge * (u - 0.5), b = 2.0 * edge * (v - 0.5);
  Vector3 direction(std::sin(a), std::cos(a) * std::sin(b), std::cos(a) * std::cos(b));
  if (opposite) {
    direction = -direction;
    const double z = std::max(direction[2], lowest);
    Vector3 level(direction[0], direction[1], 0.0);
    level = level.norm() > 1e-9 ? Vector3(level.normalized()) : Vector3(-Vector3::UnitX());
    direction = std::sqrt(1.0 - z * z) * level + z * Vector3::UnitZ();
  }
  const Vector3 axis = std::abs(direction[0]) > 0.9 ? Vector3::UnitY() : Vector3::UnitX();
  const Vector3 along = (axis - axis.dot(direction) * direction).normalized();
  return {0.5 * reference_extent(scene)[0] * direction, direction, along};
}

}  // namespace

bool is_hexahedral(const Scene& scene) {
  return scene.element == "hex8" || scene.element == "hex20" || scene.element == "mean_dilatation_hex8";
}

bool has_hexahedra(const std::string& body) {
  return body == "block" || body == "plate" || body == "lobe" || body == "dome" || body == "tube";
}

bool has_opposite(const Scene& scene) {
  return is_round(scene) || (scene.touched != "top" && scene.support != "bottom");
}

Body make_body(const Scene& scene, const Change& change) {
  Body body;
  if (is_hexahedral(scene))
    build(scene, change, body, body.hexahedra);
  else
    build(scene, change, body, body.tetrahedra);
  return body;
}

Place place_of(const Scene& scene, double u, double v, bool opposite) {
  opposite = opposite && has_opposite(scene);
  const Place on = is_round(scene) ? round_place(scene, u, v, opposite) : box_place(scene, u, v, opposite);
  const BodyMap map(scene);
  const Matrix3 jacobian = map.jacobian(on.point);
  return {map(on.point), (jacobian.inverse().transpose() * on.normal).normalized(), (jacobian * on.along).normalized()};
}

}  // namespace cross
