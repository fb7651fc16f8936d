// A surface for graphics: the boundary of the body, or a finer surface that moves with it.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/detail/bvh.hpp>
#include <palpate/contact/detail/triangle.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/detail/element_search.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/quality.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A triangle mesh for graphics. `positions` are in the frame of the mesh as given [m].
struct VisualMesh {
  std::vector<Vector3> positions;
  std::vector<std::array<int, 3>> triangles;
};

/// Quality of the embedding of a fine surface in a coarse mesh.
struct EmbeddingReport {
  Index outside = 0;          ///< points in no element; they follow the nearest element, extrapolated
  double worst_distance = 0;  ///< largest distance of these points from the boundary [m]
  double element_size = 0;    ///< mean longest edge of the boundary elements, for comparison [m]
};

namespace detail {

/// Computes a unit normal per point (the area-weighted mean of the normals of its triangles) and writes points and
/// normals as x y z. `normal` is a workspace with one entry per point. No allocation.
inline void write_surface(const std::vector<Vector3>& points, const std::vector<std::array<int, 3>>& triangles,
                          std::vector<Vector3>& normal, std::span<float> positions, std::span<float> normals) noexcept {
  for (Vector3& n : normal) n.setZero();
  for (const auto& t : triangles) {
    const auto at = [&](std::size_t k) { return static_cast<std::size_t>(t[k]); };
    const Vector3 n = cross(points[at(1)] - points[at(0)], points[at(2)] - points[at(0)]);
    for (std::size_t k = 0; k < 3; ++k) normal[at(k)] += n;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector3 unit = normal[i].squaredNorm() > 0.0 ? normal[i].normalized() : Vector3(0.0, 0.0, 1.0);
    for (int c = 0; c < 3; ++c) {
      positions[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(points[i][c]);
      normals[3 * i + static_cast<std::size_t>(c)] = static_cast<float>(unit[c]);
    }
  }
}

}  // namespace detail

/// Positions and normals for a graphics thread. Every point of the surface is a fixed combination of the nodes of one
/// element (its shape functions at the point), so a fine surface follows a coarse mesh smoothly. A read recovers the
/// displacement of the whole body from the contact forces of a tick (one back-substitution, exact). With
/// HapticServo::read_snapshot the reader and the haptic thread never wait for each other. Keeps a reference to the
/// model; one reader at a time.
template <class Model>
class VisualSurface {
 public:
  using E = typename Model::ElementType;

  /// The boundary of the body: the rendered part of the scene, or all of it when the scene selects none. One point per
  /// node.
  explicit VisualSurface(Model& model) : VisualSurface(model, boundary_of(model)) {}

  /// A user-defined surface. Throws index_out_of_range for a triangle with a point that does not exist, non_finite for
  /// a point that is not finite, empty_mesh without triangles. O(points log elements), allocates.
  VisualSurface(Model& model, VisualMesh surface)
      : model_(&model),
        surface_(checked(std::move(surface))),
        displacement_(VectorX::Zero(3 * model.mesh().node_count())) {
    for (Vector3& x : surface_.positions) x -= model.origin();
    embed();
    normals_.resize(surface_.positions.size());
    moved_.resize(surface_.positions.size());
  }

  /// For models that are cut: whether points and triangles have changed. Always false for this model.
  bool update() noexcept { return false; }

  Index point_count() const noexcept { return static_cast<Index>(surface_.positions.size()); }
  const std::vector<std::array<int, 3>>& triangles() const noexcept { return surface_.triangles; }
  const EmbeddingReport& report() const noexcept { return report_; }

  /// Writes x y z of every point and of its unit normal, world frame [m], under the contact forces of a tick
  /// (`servo.read_snapshot().vertex_forces()`; empty: at rest). Returns false and writes nothing when a span does not
  /// have 3 numbers per point. For one thread that runs next to the haptic thread; no allocation, no lock.
  bool read_surface(std::span<const VertexForce> forces, std::span<float> positions,
                    std::span<float> normals) noexcept {
    const std::size_t size = 3 * surface_.positions.size();
    if (positions.size() != size || normals.size() != size) return false;
    model_->displacement_with(forces, displacement_);
    const Eigen::Isometry3d pose = model_->to_world();
    for (std::size_t i = 0; i < moved_.size(); ++i) moved_[i] = pose * (surface_.positions[i] + displacement_at(i));
    detail::write_surface(moved_, surface_.triangles, normals_, positions, normals);
    return true;
  }
  /// Displacement of the last read_surface, 3 per admitted node [m], to compute fields from; zero before the first.
  const VectorX& displacement() const noexcept { return displacement_; }
  /// Interpolates a field with one value per admitted node, such as StressField::von_mises_nodes, to the points.
  /// Returns false and writes nothing when a length is wrong. No allocation, no lock.
  bool read_field(const VectorX& at_nodes, std::span<float> values) const noexcept {
    if (at_nodes.size() != model_->mesh().node_count() || values.size() != anchors_.size()) return false;
    for (std::size_t i = 0; i < values.size(); ++i) {
      double value = 0.0;
      for (int a = 0; a < E::nodes; ++a)
        value += anchors_[i].weights[a] * at_nodes[model_->mesh().element_node(anchors_[i].element, a)];
      values[i] = static_cast<float>(value);
    }
    return true;
  }

 private:
  struct Anchor {
    Index element = 0;
    Eigen::Matrix<double, E::nodes, 1> weights;
  };

  static VisualMesh checked(VisualMesh surface) {
    if (surface.triangles.empty()) raise(SetupErrorKind::empty_mesh, "the surface to draw has no triangles");
    for (const Vector3& x : surface.positions)
      if (!all_finite(x)) raise(SetupErrorKind::non_finite, "a point of the surface to draw is not finite");
    for (const auto& t : surface.triangles)
      for (const int v : t)
        if (v < 0 || static_cast<std::size_t>(v) >= surface.positions.size())
          raise(SetupErrorKind::index_out_of_range,
                "a triangle of the surface to draw refers to point " + std::to_string(v));
    return surface;
  }

  /// Triangles of the boundary faces whose nodes are all rendered, in the frame of the mesh as given.
  static VisualMesh boundary_of(const Model& model) {
    std::vector<NodeId> nodes = model.rendered_nodes();
    if (nodes.empty()) nodes = nodes_of(model.boundary());
    VisualMesh surface;
    for (const NodeId i : nodes) surface.positions.push_back(model.rest_position(i));
    const auto point = [&](NodeId i) { return static_cast<int>(std::ranges::lower_bound(nodes, i) - nodes.begin()); };
    for (const auto& face : model.boundary()) {
      if (!std::ranges::all_of(face.nodes, [&](NodeId i) { return std::ranges::binary_search(nodes, i); })) continue;
      detail::with_face_element<E>(face.nodes.size(), [&]<TriangulatedFace F>() {
        for (const auto& t : F::triangles) {
          const auto at = [&](std::size_t k) { return point(face.nodes[static_cast<std::size_t>(t[k])]); };
          surface.triangles.push_back({at(0), at(1), at(2)});
        }
      });
    }
    return surface;
  }

  void embed() {
    const Mesh<E>& mesh = model_->mesh();
    const detail::ElementSearch<E> inside(mesh);
    const Boundary boundary(*model_);
    report_.element_size = boundary.mean_edge;
    for (const Vector3& p : surface_.positions) {
      auto place = inside.find(p);
      if (!place) {
        const auto [element, distance] = boundary.nearest(p);
        place = beyond(element, p);
        ++report_.outside;
        report_.worst_distance = std::max(report_.worst_distance, distance);
      }
      anchors_.push_back({place->element, E::shape(place->xi)});
    }
  }

  /// The triangles of the boundary, to find the element nearest to an outside point.
  struct Boundary {
    explicit Boundary(const Model& model) {
      for (const auto& face : model.boundary()) {
        detail::with_face_element<E>(face.nodes.size(), [&]<TriangulatedFace F>() {
          const int first = static_cast<int>(corners.size());
          for (const NodeId i : face.nodes) corners.push_back(model.mesh().position(i));
          for (const auto& [a, b, c] : F::triangles) {
            triangles.push_back({first + a, first + b, first + c});
            owner.push_back(face.element);
          }
        });
        mean_edge += detail::longest_edge<E>(element_nodes<E>(model.mesh(), face.element));
      }
      mean_edge /= static_cast<double>(model.boundary().size());
      bvh = detail::Bvh(triangles, corners);
    }

    double squared_distance(const Vector3& p, int triangle) const {
      const auto& [i, j, k] = triangles[static_cast<std::size_t>(triangle)];
      const auto corner = [&](int v) -> const Vector3& { return corners[static_cast<std::size_t>(v)]; };
      const Vector3& a = corner(i);
      const Vector3& b = corner(j);
      const Vector3& c = corner(k);
      const auto w = detail::closest_point(p, a, b, c).weights;
      return (p - w[0] * a - w[1] * b - w[2] * c).squaredNorm();
    }

    std::pair<Index, double> nearest(const Vector3& p) const {
      const int t = bvh.nearest(p, [&](int triangle) { return squared_distance(p, triangle); });
      return {owner[static_cast<std::size_t>(t)], std::sqrt(squared_distance(p, t))};
    }

    std::vector<Vector3> corners;
    std::vector<Triangle> triangles;
    std::vector<Index> owner;
    double mean_edge = 0.0;
    detail::Bvh bvh;
  };

  /// The point in the extrapolated coordinates of an element; the centre of the element where Newton's method fails.
  detail::ElementPoint beyond(Index element, const Vector3& p) const noexcept {
    const auto xi = detail::reference_coordinates<E>(element_nodes<E>(model_->mesh(), element), p);
    return {element, xi.value_or(detail::reference_centre<E>())};
  }

  Vector3 displacement_at(std::size_t point) const noexcept {
    const Anchor& anchor = anchors_[point];
    Vector3 u = Vector3::Zero();
    for (int a = 0; a < E::nodes; ++a)
      u += anchor.weights[a] * node_vector(displacement_, model_->mesh().element_node(anchor.element, a));
    return u;
  }

  Model* model_;
  VisualMesh surface_;
  EmbeddingReport report_;
  std::vector<Anchor> anchors_;
  std::vector<Vector3> moved_, normals_;
  VectorX displacement_;
};

}}  // namespace palpate
