// Stress at the nodes to trust: superconvergent patch recovery.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/promote.hpp>
#include <palpate/post/detail/patch_polynomial.hpp>
#include <palpate/post/detail/point_stress.hpp>
#include <palpate/quadrature/tensor.hpp>
#include <palpate/quadrature/tetrahedron.hpp>

#include <algorithm>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Stress at the nodes [Pa], one column per node and region of an element around it: between two materials the stress
/// jumps, and a node there has two.
struct NodalStress {
  StressColumns stress;
  std::vector<Index> first;  ///< columns of node i are first[i] ... first[i + 1] - 1; none at a node of no element
  std::vector<int> region;   ///< of every column, rising within a node

  /// The column of a node seen from a region; -1 when no element of it meets there.
  Index column(Index node, int of_region) const noexcept;
  /// Stress at a node [Pa]; where regions meet, that of the one with the lowest number. Zero at a node of no element.
  Vector6 at(Index node) const noexcept;
};

/// Where patch recovery looks at an element's stress, and how many such points it wants per unknown: the centre of Hex8
/// and eight points of Hex20, where the stress is better than elsewhere (Barlow 1976), by ten times near
/// incompressibility; one or four points in tetrahedra, and more of them, for their stress scatters. Other elements:
/// the points of their own rule.
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

namespace detail {

/// Patches around the corner nodes of one mesh, and what is sampled in their elements.
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
  using Polynomial = PatchPolynomial<std::min(E::order, 2)>;
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

  Polynomial through(Index node, const std::vector<NodeId>& patch, const Samples& samples) const {
    std::vector<Vector3> corner_points, points;
    StressColumns stress(6, static_cast<Index>(patch.size()) * samples.per_element);
    for (const NodeId e : patch) {
      for (int a = 0; a < corners; ++a) corner_points.push_back(mesh().position(Index{mesh().element_node(e, a)}));
      for (Index q = Index{e} * samples.per_element; q < (Index{e} + 1) * samples.per_element; ++q) {
        stress.col(static_cast<Index>(points.size())) = samples.stress.col(q);
        points.push_back(samples.points[static_cast<std::size_t>(q)]);
      }
    }
    return Polynomial(patch_frame(corner_points), mesh().position(node), points, stress, SamplingRule<E>::oversampling);
  }

  /// From the elements at a corner, and while these do not determine it, from those around them. In a body with too few
  /// elements for that, from the points of the element's own rule, with no slope where even these show none.
  Polynomial fit(Index node, int region) const {
    std::vector<NodeId> patch;
    for (const NodeId e : around_.of(node))
      if (mesh().region(e) == region) patch.push_back(e);
    const std::vector<NodeId> smallest = patch;
    for (int ring = 1;; ++ring) {
      Polynomial polynomial = through(node, patch, good_);
      if (polynomial.complete()) return polynomial;
      const std::size_t before = patch.size();
      if (ring < most_rings) grow(patch, region);
      if (patch.size() == before) break;
    }
    if (own_.per_element == 0) return through(node, patch, good_);
    Polynomial polynomial = through(node, smallest, own_);
    return polynomial.complete() ? polynomial : through(node, patch, own_);
  }

  void add(Index node, int region, const Polynomial& polynomial) {
    const Index k = nodal_.column(node, region);
    nodal_.stress.col(k) += polynomial(mesh().position(node));
    ++parts_[static_cast<std::size_t>(k)];
  }

  /// The polynomial's value at its corner, and at the middles of the edges that end there, which have two such values.
  void spread(Index node, int region, const Polynomial& polynomial) {
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
/// of SamplingRule; nodes in the middle of an edge take the mean of its two ends. Exact when the stress is a polynomial
/// of degree order - 1; on even meshes of hexahedra of degree order. Regions are kept apart. Where a patch does not
/// determine its polynomial (at surfaces) it grows by up to two rings of elements; what cannot be determined then gets
/// no slope, so that a body of a single element has its mean. What is not finite in `u` stays so in the patches that
/// see it. Costs 3 to 12 us a node, allocates: for looking at results, not for every
/// frame. Throws bad_argument when `u` has another length.
template <Element E>
NodalStress patch_recovery(const Body<E>& body, const VectorX& u) {
  require_displacement(body.mesh, u);
  return detail::PatchRecovery<E>(body, u).recover();
}

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/post/detail/patch_recovery.ipp>
#endif
