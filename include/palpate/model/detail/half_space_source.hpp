// What is needed of a body to project the compliance of a half-space on its mesh.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/contact/detail/projected_half_space.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/surface.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/quadrature/simplex.hpp>

#include <array>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Faces, triangles, normal and scale of the boundary at every node. Nodes inside the body have none. O(faces),
/// allocates.
class BoundaryNodes {
 public:
  /// Normals that differ by more than 45 degrees make an edge between facets sharp.
  static constexpr double sharp_cosine = 0.70710678118654752440;

  /// Keeps a reference to the faces.
  BoundaryNodes(const MeshRef& mesh, const std::vector<BoundaryFace>& faces);

  const BoundaryFace& face(int f) const noexcept { return (*faces_)[static_cast<std::size_t>(f)]; }
  const std::array<NodeId, 3>& triangle(int t) const noexcept { return triangles_[static_cast<std::size_t>(t)]; }
  /// Outward unit normal of a triangle.
  const Vector3& triangle_normal(int t) const noexcept { return triangle_normals_[static_cast<std::size_t>(t)]; }
  std::span<const NodeId> faces_at(NodeId node) const noexcept { return faces_at_.of(node); }
  std::span<const NodeId> triangles_at(NodeId node) const noexcept { return triangles_at_.of(node); }
  bool is_on_boundary(NodeId node) const noexcept { return !triangles_at_.of(node).empty(); }
  /// Outward unit normal, the mean of the triangles with their angles at the node as weights; zero where they cancel.
  Vector3 normal(NodeId node) const noexcept;
  /// Mean length of the edges at the node [m].
  double length(NodeId node) const noexcept;
  /// Whether the node is on a sharp edge, or on one with fewer or more than two triangles.
  bool is_sharp(NodeId node) const noexcept { return sharp_[static_cast<std::size_t>(node)]; }
  Vector3 position(NodeId node) const noexcept;

 private:
  void list_triangles(const MeshRef& mesh);
  void find_sharp_edges();

  const double* positions_;
  const std::vector<BoundaryFace>* faces_;
  std::vector<std::array<NodeId, 3>> triangles_;
  std::vector<Vector3> triangle_normals_;
  NodeLists faces_at_, triangles_at_;
  std::vector<bool> sharp_;
};

/// One point of a rule: shape functions of the nodes of the face, their derivatives by the two reference coordinates,
/// and the weight.
struct FacePoint {
  std::array<double, max_face_nodes> shape{}, along_u{}, along_v{};
  double weight = 0.0;
};

using FaceRule = std::vector<FacePoint>;

/// Rules for one kind of face: for smooth functions, and for functions that are singular at a node, where the product
/// with the area element of polar coordinates around the node is smooth.
struct FaceRules {
  FaceRule smooth, near_singularity;  ///< `near`: for a singularity closer than the size of the face
  std::vector<FaceRule> singular_at;  ///< per node
};

/// The rules of an element type.
struct ElementFaceRules {
  int small_nodes = 0;  ///< of small faces; 0 if there are none
  FaceRules face, small_face;

  const FaceRules& of(std::size_t nodes) const noexcept {
    return static_cast<int>(nodes) == small_nodes ? small_face : face;
  }
};

template <TriangulatedFace F>
void add_face_point(FaceRule& rule, const Eigen::Vector2d& xi, double weight) {
  static_assert(F::nodes <= max_face_nodes);
  const auto shape = F::shape(xi);
  const auto gradient = F::gradient(xi);
  FacePoint& point = rule.emplace_back();
  point.weight = weight;
  for (int a = 0; a < F::nodes; ++a) {
    const auto i = static_cast<std::size_t>(a);
    point.shape[i] = shape[a];
    point.along_u[i] = gradient.coeff(a, 0);
    point.along_v[i] = gradient.coeff(a, 1);
  }
}

/// Corners of a triangle in reference coordinates, and twice its area.
struct ReferenceTriangle {
  Eigen::Vector2d a, ab, ac;
  double area = 0.0;

  template <TriangulatedFace F>
  static ReferenceTriangle of(std::size_t triangle, std::size_t first) {
    const auto nodes = F::reference_nodes();
    const auto& t = F::triangles[triangle];
    const auto corner = [&](std::size_t i) {
      const int n = t[(first + i) % 3];
      return Eigen::Vector2d(nodes.coeff(n, 0), nodes.coeff(n, 1));
    };
    ReferenceTriangle r{corner(0), corner(1) - corner(0), corner(2) - corner(0)};
    r.area = r.ab[0] * r.ac[1] - r.ab[1] * r.ac[0];
    return r;
  }
};

/// Seven points in each of parts x parts similar triangles.
template <TriangulatedFace F>
void add_smooth(FaceRule& rule, const ReferenceTriangle& t, int parts) {
  const double size = 1.0 / parts, weight = t.area * size * size;
  const auto add = [&](double u, double v, double scale) {
    for (const auto& p : TriangleRule<5>::points)
      add_face_point<F>(rule, t.a + (u + scale * p.xi[0]) * t.ab + (v + scale * p.xi[1]) * t.ac, p.weight * weight);
  };
  for (int i = 0; i < parts; ++i)
    for (int j = 0; i + j < parts; ++j) {
      add(i * size, j * size, size);
      if (i + j + 2 <= parts) add((i + 1) * size, (j + 1) * size, -size);
    }
}

/// Polar coordinates around the first corner (Duffy 1982): the area element contains the distance from it.
template <TriangulatedFace F>
void add_collapsed(FaceRule& rule, const ReferenceTriangle& t) {
  for (const auto& p : GaussLegendre<3>::points)
    for (const auto& q : GaussLegendre<5>::points) {
      const double along = 0.5 * (p.xi[0] + 1.0), across = 0.5 * (q.xi[0] + 1.0);
      add_face_point<F>(rule, t.a + along * ((1.0 - across) * t.ab + across * t.ac),
                        0.25 * p.weight * q.weight * along * t.area);
    }
}

template <TriangulatedFace F>
FaceRule face_rule(int singular_node, int parts) {
  constexpr std::size_t none = 3;
  FaceRule rule;
  for (std::size_t t = 0; t < F::triangles.size(); ++t) {
    std::size_t first = none;
    for (std::size_t i = 0; i < 3; ++i)
      if (F::triangles[t][i] == singular_node) first = i;
    if (first != none)
      add_collapsed<F>(rule, ReferenceTriangle::of<F>(t, first));
    else
      add_smooth<F>(rule, ReferenceTriangle::of<F>(t, 0), parts);
  }
  return rule;
}

template <TriangulatedFace F>
FaceRules face_rules() {
  FaceRules rules{face_rule<F>(-1, 1), face_rule<F>(-1, 2), {}};
  for (int a = 0; a < F::nodes; ++a) rules.singular_at.push_back(face_rule<F>(a, 1));
  return rules;
}

/// The rules of element E, whose faces tools can touch.
template <Element E>
ElementFaceRules element_face_rules() {
  ElementFaceRules rules{0, face_rules<typename E::Face>(), {}};
  if constexpr (HasSmallFace<E>) {
    rules.small_nodes = E::SmallFace::nodes;
    rules.small_face = face_rules<typename E::SmallFace>();
  }
  return rules;
}

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

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/detail/half_space_source.ipp>
#endif
