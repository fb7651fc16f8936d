// Accurate stress at the nodes: superconvergent patch recovery.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/post/point_stress.hpp>
#include <palpate/quadrature/gauss_legendre.hpp>
#include <palpate/quadrature/simplex.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Coordinates that map a patch of elements of any aspect ratio to about a unit sphere around its centre.
struct PatchFrame {
  Vector3 centre = Vector3::Zero();
  Matrix3 map = Matrix3::Identity();  ///< [1/m]

  Vector3 operator()(const Vector3& x) const noexcept;
};

/// The frame of points: their mean, and the inverse of their Cholesky-factorised covariance.
PatchFrame patch_frame(const std::vector<Vector3>& points);

/// Least-squares fit of a polynomial of degree 1 or 2 to every stress component, points weighted by the inverse of
/// their distance to the node. A constant is reproduced exactly; directions in which the points do not differ get zero
/// slope.
class PatchPolynomial {
 public:
  /// Fits to one stress per point (at least one point). `complete` requires `oversampling` points per term. O(points x
  /// terms^2), allocates.
  PatchPolynomial(int degree, const PatchFrame& frame, const Vector3& node, const std::vector<Vector3>& points,
                  const StressColumns& stress, int oversampling);

  /// Whether the points determine the polynomial, with the required oversampling.
  bool complete() const noexcept { return complete_; }

  Vector6 operator()(const Vector3& x) const noexcept;

 private:
  static constexpr int most_terms = 9;
  using Terms = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, most_terms, 1>;

  Terms powers(const Vector3& x) const noexcept;

  int terms_;  ///< without the constant
  PatchFrame frame_;
  Vector6 mean_;
  Terms mean_powers_;
  Eigen::Matrix<double, Eigen::Dynamic, 6, 0, most_terms, 6> slopes_;
  bool complete_ = false;
};

}  // namespace detail

/// Stress at the nodes [Pa], one column per node and adjacent region: the stress jumps between two materials, so a node
/// on an interface has two columns.
struct NodalStress {
  StressColumns stress;
  std::vector<Index> first;  ///< columns of node i are first[i] ... first[i + 1] - 1; empty for a node without elements
  std::vector<int> region;   ///< of every column, ascending within a node

  /// The column of a node for a region; -1 when no element of the region contains the node.
  Index column(Index node, int of_region) const noexcept;
  /// Stress at a node [Pa]; on an interface, that of the region with the lowest number. Zero at a node without
  /// elements.
  Vector6 at(Index node) const noexcept;
};

namespace detail {

/// Sampling points of patch recovery in an element, and the required number of points per unknown. Hexahedra: the
/// centre of Hex8 and eight points of Hex20, where the stress is more accurate than elsewhere (Barlow 1976), ten times
/// near incompressibility. Tetrahedra: one or four points, with more oversampling because their stress scatters. Other
/// elements: their own quadrature points.
template <Element E>
struct SamplingRule {
  using Type = typename E::Quadrature;
  static constexpr int oversampling = 2;
};
template <Element E>
requires(E::faces.size() == 4 && E::order <= 2) struct SamplingRule<E> {
  using Type = TetrahedronRule<E::order>;
  static constexpr int oversampling = 4;
};
template <Element E>
requires(E::faces.size() == 6 && E::order <= 2) struct SamplingRule<E> {
  using Type = HexahedronRule<E::order>;
  static constexpr int oversampling = 2;
};

/// Patches around the corner nodes of one mesh, and the stress samples in their elements.
template <Element E>
class PatchRecovery {
 public:
  PatchRecovery(const Body<E>& body, const VectorX& u) : body_(body), state_(body, u), around_(body.mesh) {
    number_columns();
  }

  NodalStress recover() {
    sample<typename SamplingRule<E>::Type>(good_);
    constexpr bool other_rule = E::Quadrature::points.size() != SamplingRule<E>::Type::points.size();
    if constexpr (other_rule) sample<typename E::Quadrature>(own_);
    const Index count = static_cast<Index>(nodal_.region.size());
    nodal_.stress = StressColumns::Zero(6, count);
    parts_.assign(static_cast<std::size_t>(count), 0);
    for (Index node = 0; node < mesh().node_count(); ++node)
      for (Index k = first(node); k < first(node + 1); ++k) {
        const int region = nodal_.region[static_cast<std::size_t>(k)];
        if (is_corner(node, region)) spread(node, region, fit(node, region));
      }
    for (Index k = 0; k < count; ++k)
      if (parts_[static_cast<std::size_t>(k)] > 0) nodal_.stress.col(k) /= parts_[static_cast<std::size_t>(k)];
    return std::move(nodal_);
  }

 private:
  static constexpr int most_rings = 3;

  /// Points of all elements, the same number in each, with their stress.
  struct Samples {
    std::vector<Vector3> points;
    StressColumns stress;
    Index per_element = 0;
  };

  static constexpr int corner_count() {
    if constexpr (QuadraticElement<E>)
      return E::Linear::nodes;
    else
      return E::nodes;
  }
  static constexpr int corners = corner_count();

  const Mesh<E>& mesh() const noexcept { return body_.mesh; }
  Index first(Index node) const noexcept { return nodal_.first[static_cast<std::size_t>(node)]; }

  void number_columns() {
    nodal_.first.push_back(0);
    for (Index node = 0; node < mesh().node_count(); ++node) {
      const auto start = nodal_.region.end() - nodal_.region.begin();
      for (const NodeId e : around_.of(node)) {
        const int region = mesh().region(e);
        if (std::find(nodal_.region.begin() + start, nodal_.region.end(), region) == nodal_.region.end())
          nodal_.region.push_back(region);
      }
      std::sort(nodal_.region.begin() + start, nodal_.region.end());
      nodal_.first.push_back(static_cast<Index>(nodal_.region.size()));
    }
  }

  template <Quadrature Rule>
  void sample(Samples& samples) const {
    samples.per_element = static_cast<Index>(Rule::points.size());
    samples.stress.resize(6, mesh().element_count() * samples.per_element);
    samples.points.reserve(static_cast<std::size_t>(samples.stress.cols()));
    for (Index e = 0; e < mesh().element_count(); ++e)
      for (const StressPoint& point : state_.template points<Rule>(e)) {
        samples.stress.col(static_cast<Index>(samples.points.size())) = point.stress;
        samples.points.push_back(point.position);
      }
  }

  int local_node(Index e, Index node) const noexcept {
    int a = 0;
    while (Index{mesh().element_node(e, a)} != node) ++a;
    return a;
  }

  bool is_corner(Index node, int region) const noexcept {
    return std::ranges::any_of(around_.of(node),
                               [&](NodeId e) { return mesh().region(e) == region && local_node(e, node) < corners; });
  }

  /// The elements of the patch and of those that touch it, in the same region.
  void grow(std::vector<NodeId>& patch, int region) const {
    std::vector<NodeId> grown = patch;
    for (const NodeId e : patch)
      for (int a = 0; a < corners; ++a)
        for (const NodeId neighbour : around_.of(mesh().element_node(e, a)))
          if (mesh().region(neighbour) == region) grown.push_back(neighbour);
    std::ranges::sort(grown);
    grown.erase(std::unique(grown.begin(), grown.end()), grown.end());
    patch.swap(grown);
  }

  PatchPolynomial through(Index node, const std::vector<NodeId>& patch, const Samples& samples) const {
    std::vector<Vector3> corner_points, points;
    StressColumns stress(6, static_cast<Index>(patch.size()) * samples.per_element);
    for (const NodeId e : patch) {
      for (int a = 0; a < corners; ++a) corner_points.push_back(mesh().position(Index{mesh().element_node(e, a)}));
      for (Index q = Index{e} * samples.per_element; q < (Index{e} + 1) * samples.per_element; ++q) {
        stress.col(static_cast<Index>(points.size())) = samples.stress.col(q);
        points.push_back(samples.points[static_cast<std::size_t>(q)]);
      }
    }
    return PatchPolynomial(std::min(E::order, 2), patch_frame(corner_points), mesh().position(node), points, stress,
                           SamplingRule<E>::oversampling);
  }

  /// Fits the polynomial to the elements at a corner; while these do not determine it, adds the elements around them.
  /// When the body has too few elements, uses the element's own quadrature points, with zero slope in undetermined
  /// directions.
  PatchPolynomial fit(Index node, int region) const {
    std::vector<NodeId> patch;
    for (const NodeId e : around_.of(node))
      if (mesh().region(e) == region) patch.push_back(e);
    const std::vector<NodeId> smallest = patch;
    for (int ring = 1;; ++ring) {
      PatchPolynomial polynomial = through(node, patch, good_);
      if (polynomial.complete()) return polynomial;
      const std::size_t before = patch.size();
      if (ring < most_rings) grow(patch, region);
      if (patch.size() == before) break;
    }
    if (own_.per_element == 0) return through(node, patch, good_);
    PatchPolynomial polynomial = through(node, smallest, own_);
    return polynomial.complete() ? polynomial : through(node, patch, own_);
  }

  void add(Index node, int region, const PatchPolynomial& polynomial) {
    const Index k = nodal_.column(node, region);
    nodal_.stress.col(k) += polynomial(mesh().position(node));
    ++parts_[static_cast<std::size_t>(k)];
  }

  /// Adds the value of the polynomial at its corner, and at the midside nodes of the edges that end there; a midside
  /// node gets two such values.
  void spread(Index node, int region, const PatchPolynomial& polynomial) {
    add(node, region, polynomial);
    if constexpr (QuadraticElement<E>) {
      std::vector<NodeId> middles;
      for (const NodeId e : around_.of(node)) {
        if (mesh().region(e) != region) continue;
        const int corner = local_node(e, node);
        for (std::size_t i = 0; i < E::edges.size(); ++i)
          if (E::edges[i][0] == corner || E::edges[i][1] == corner)
            middles.push_back(mesh().element_node(e, corners + static_cast<int>(i)));
      }
      std::ranges::sort(middles);
      middles.erase(std::unique(middles.begin(), middles.end()), middles.end());
      for (const NodeId middle : middles) add(Index{middle}, region, polynomial);
    }
  }

  const Body<E>& body_;
  ElementStress<E> state_;
  NodeElements around_;
  NodalStress nodal_;
  Samples good_, own_;
  std::vector<int> parts_;
};

}  // namespace detail

/// Stress at the nodes under the displacement `u` (3 per node [m]), by superconvergent patch recovery (Zienkiewicz and
/// Zhu 1992): around every corner a polynomial of the element's order (at most 2) is fitted to the stress in the points
/// of SamplingRule; midside nodes take the mean of the values from the two ends of their edge. Exact when the stress is
/// a polynomial of degree order - 1; on uniform meshes of hexahedra also of degree order. Regions are recovered
/// separately. A patch that does not determine its polynomial (at surfaces) grows by up to two rings of elements;
/// directions that are still undetermined get zero slope, so a body of a single element gets its mean. Values of `u`
/// that are not finite give stress that is not finite in the patches that contain them. Costs 3 to 12 us per node,
/// allocates: for evaluating results, not for every frame. Throws bad_argument when `u` has a wrong length.
template <Element E>
NodalStress patch_recovery(const Body<E>& body, const VectorX& u) {
  detail::require_displacement(body.mesh, u);
  return detail::PatchRecovery<E>(body, u).recover();
}

inline Index NodalStress::column(Index node, int of_region) const noexcept {
  for (Index k = first[static_cast<std::size_t>(node)]; k < first[static_cast<std::size_t>(node) + 1]; ++k)
    if (region[static_cast<std::size_t>(k)] == of_region) return k;
  return -1;
}

inline Vector6 NodalStress::at(Index node) const noexcept {
  const Index k = first[static_cast<std::size_t>(node)];
  if (k == first[static_cast<std::size_t>(node) + 1]) return Vector6::Zero();
  return stress.col(k);
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/post/patch_recovery.ipp>
#endif
