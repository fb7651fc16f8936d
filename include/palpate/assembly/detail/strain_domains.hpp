// Domains over which a smoothed strain is averaged, and their elasticity.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/assembly/detail/node_elements.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/core/voigt.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The part of the elasticity that acts on the strain of a domain.
enum class StrainPart : std::uint8_t { deviatoric, volumetric };

/// The elements of one region around an edge (one sixth of each), or around a node (one quarter of each). Their mean
/// strain is sum B_a u_a with the mean gradients.
struct StrainDomain {
  std::span<const NodeId> nodes;       ///< ascending
  std::span<const Vector3> gradients;  ///< per node, mean over the domain [1/m]
  std::span<const NodeId> elements;
  double volume = 0.0;  ///< [m^3]
  int region = 0;
  StrainPart part = StrainPart::deviatoric;
  std::array<NodeId, 2> ends{};  ///< of the edge, ascending; or -1 and the node

  /// Mean strain under nodal displacements u, 3 per node of the mesh [m].
  Vector6 strain(const VectorX& u) const noexcept;
  /// Adds the nodal forces of a stress [Pa] to f, 3 per node of the mesh [N].
  void add_force(const Vector6& stress, VectorX& f) const noexcept;
};

enum class DomainContents : std::uint8_t {
  gradients,  ///< all of StrainDomain
  elements,   ///< without nodes and gradients: less time and memory
};

/// All domains of a mesh, per region: a deviatoric one for every edge, a volumetric one for every node. About 2 kB per
/// node with gradients.
template <HasSmoothedStrain E>
class StrainDomains {
 public:
  StrainDomains() = default;

  /// O(elements). Throws inverted_element, non_finite, too_large or cancelled.
  StrainDomains(const Mesh<E>& mesh, const NodeElements& around, const SetupLimits& limits = {},
                DomainContents contents = DomainContents::gradients)
      : geometry_(element_geometry(mesh, limits)),
        place_(static_cast<std::size_t>(mesh.node_count()), unused),
        contents_(contents) {
    for (Index i = 0; i < mesh.node_count(); ++i) {
      if (i % 8192 == 0) limits.advance("assembly", static_cast<double>(i) / static_cast<double>(mesh.node_count()));
      collect_shares(mesh, around, i);
      for (auto first = shares_.begin(); first != shares_.end();) {
        const auto last = std::find_if(first, shares_.end(), [&](const Share& s) { return !s.same_domain(*first); });
        add_domain(mesh, i, {first, last});
        first = last;
      }
    }
    geometry_ = {};
    place_ = {};
  }
  explicit StrainDomains(const Mesh<E>& mesh) : StrainDomains(mesh, NodeElements(mesh)) {}

  Index size() const noexcept { return static_cast<Index>(volume_.size()); }
  StrainDomain operator[](Index d) const noexcept {
    const auto i = static_cast<std::size_t>(d);
    const std::size_t n = node_start_[i], e = element_start_[i];
    return {{node_.data() + n, node_start_[i + 1] - n},
            {gradient_.data() + n, node_start_[i + 1] - n},
            {element_.data() + e, element_start_[i + 1] - e},
            volume_[i],
            region_[i],
            part_[i],
            ends_[i]};
  }
  std::size_t bytes() const noexcept {
    return node_.size() * (sizeof(NodeId) + sizeof(Vector3)) + element_.size() * sizeof(NodeId) +
           volume_.size() *
               (sizeof(double) + sizeof(int) + sizeof(StrainPart) + 2 * sizeof(NodeId) + 2 * sizeof(std::size_t));
  }

 private:
  /// The share of an element in the domain of the edge from the current node to `other`, or of the node itself (-1).
  struct Share {
    NodeId other;
    int region;
    NodeId element;
    bool same_domain(const Share& s) const noexcept { return other == s.other && region == s.region; }
    friend auto operator<=>(const Share&, const Share&) = default;
  };

  static std::vector<PointGeometry<E>> element_geometry(const Mesh<E>& mesh, const SetupLimits& limits) {
    limits.require_memory(static_cast<double>(mesh.element_count()) * sizeof(PointGeometry<E>) +
                              2000.0 * static_cast<double>(mesh.node_count()),
                          "the smoothed strain domains");
    std::vector<PointGeometry<E>> geometry;
    geometry.reserve(static_cast<std::size_t>(mesh.element_count()));
    for (Index e = 0; e < mesh.element_count(); ++e) geometry.push_back(constant_geometry(mesh, e));
    return geometry;
  }

  /// Collects the shares of all domains that belong to a node: its own, and those of its edges to nodes of higher id.
  void collect_shares(const Mesh<E>& mesh, const NodeElements& around, Index i) {
    shares_.clear();
    for (const NodeId e : around.of(i)) {
      shares_.push_back({-1, mesh.region(e), e});
      for (const NodeId j : mesh.elements[static_cast<std::size_t>(e)])
        if (j > i) shares_.push_back({j, mesh.region(e), e});
    }
    std::ranges::sort(shares_);
  }

  /// `node` has the lowest id of the domain's edge, or is its node.
  void add_domain(const Mesh<E>& mesh, Index node, std::span<const Share> shares) {
    const bool of_node = shares.front().other < 0;
    const double part = of_node ? 1.0 / 4.0 : 1.0 / 6.0;
    double volume = 0.0;
    for (const Share& s : shares) {
      element_.push_back(s.element);
      volume += part * geometry_[static_cast<std::size_t>(s.element)].volume;
    }
    if (contents_ == DomainContents::gradients) add_gradients(mesh, shares, part / volume);
    volume_.push_back(volume);
    region_.push_back(shares.front().region);
    part_.push_back(of_node ? StrainPart::volumetric : StrainPart::deviatoric);
    const auto own = static_cast<NodeId>(node), other = shares.front().other;
    ends_.push_back({std::min(own, other), std::max(own, other)});
    node_start_.push_back(node_.size());
    element_start_.push_back(element_.size());
  }

  /// Appends the nodes of a domain and their mean gradients; `share` is the part of an element per volume of the
  /// domain.
  void add_gradients(const Mesh<E>& mesh, std::span<const Share> shares, double share) {
    number_nodes(mesh, shares);
    gradient_.resize(node_.size(), Vector3::Zero());
    for (const Share& s : shares) {
      const PointGeometry<E>& g = geometry_[static_cast<std::size_t>(s.element)];
      for (int a = 0; a < E::nodes; ++a)
        for (int i = 0; i < 3; ++i)
          gradient_[index_of(mesh.element_node(s.element, a))][i] += share * g.volume * g.gradient.coeff(a, i);
    }
    for (std::size_t a = node_start_.back(); a < node_.size(); ++a) index_of(node_[a]) = unused;
  }

  /// Appends the nodes of a domain, and records the position of every node.
  void number_nodes(const Mesh<E>& mesh, std::span<const Share> shares) {
    for (const Share& s : shares)
      for (const NodeId j : mesh.elements[static_cast<std::size_t>(s.element)]) {
        if (index_of(j) != unused) continue;
        index_of(j) = 0;
        node_.push_back(j);
      }
    std::sort(node_.begin() + static_cast<std::ptrdiff_t>(node_start_.back()), node_.end());
    for (std::size_t a = node_start_.back(); a < node_.size(); ++a) index_of(node_[a]) = a;
  }
  std::size_t& index_of(NodeId node) noexcept { return place_[static_cast<std::size_t>(node)]; }

  static constexpr auto unused = static_cast<std::size_t>(-1);
  std::vector<std::size_t> node_start_{0}, element_start_{0};
  std::vector<NodeId> node_, element_;
  std::vector<Vector3> gradient_;
  std::vector<double> volume_;
  std::vector<int> region_;
  std::vector<StrainPart> part_;
  std::vector<std::array<NodeId, 2>> ends_;
  std::vector<PointGeometry<E>> geometry_;  // during construction only
  std::vector<std::size_t> place_;          // position of a node in node_
  std::vector<Share> shares_;
  DomainContents contents_ = DomainContents::gradients;
};

inline Vector6 StrainDomain::strain(const VectorX& u) const noexcept {
  Vector6 e = Vector6::Zero();
  for (std::size_t a = 0; a < nodes.size(); ++a) {
    const double* const ua = u.data() + 3 * Index{nodes[a]};
    const Vector3& g = gradients[a];
    e[voigt::xx] += ua[0] * g[0];
    e[voigt::yy] += ua[1] * g[1];
    e[voigt::zz] += ua[2] * g[2];
    e[voigt::xy] += ua[0] * g[1] + ua[1] * g[0];
    e[voigt::xz] += ua[0] * g[2] + ua[2] * g[0];
    e[voigt::yz] += ua[1] * g[2] + ua[2] * g[1];
  }
  return e;
}

inline void StrainDomain::add_force(const Vector6& stress, VectorX& f) const noexcept {
  const Matrix3 tensor = volume * voigt::stress_tensor(stress);
  for (std::size_t a = 0; a < nodes.size(); ++a) add_node_vector(f, nodes[a], tensor * gradients[a]);
}

/// The part of the elasticity [Pa] that acts in each domain of a body. If the elasticity differs between elements
/// (along fibres), the volume-weighted mean over the domain: 288 bytes per domain.
class DomainElasticity {
 public:
  DomainElasticity() = default;

  template <HasSmoothedStrain E>
  DomainElasticity(const Body<E>& body, const StrainDomains<E>& domains) : by_domain_(!body.materials.empty()) {
    std::vector<Matrix6> materials;  // both parts of each matrix
    for (const Matrix6& d : body.elasticity) {
      const SplitElasticity split = split_elasticity(d);
      materials.push_back(split.deviatoric);
      materials.push_back(split.volumetric);
    }
    if (!by_domain_) {
      elasticity_ = std::move(materials);
      return;
    }
    for (Index d = 0; d < domains.size(); ++d) {
      const StrainDomain domain = domains[d];
      Matrix6 sum = Matrix6::Zero();
      double volume = 0.0;
      for (const NodeId e : domain.elements) {
        const double v = constant_geometry(body.mesh, Index{e}).volume;
        sum += v * materials[index(body.material_of(e), domain.part)];
        volume += v;
      }
      elasticity_.push_back(sum / volume);
    }
  }

  std::size_t bytes() const noexcept { return elasticity_.size() * sizeof(Matrix6); }
  /// Elasticity of domain number d.
  const Matrix6& operator()(Index d, const StrainDomain& domain) const noexcept;

 private:
  static std::size_t index(std::size_t material, StrainPart part) noexcept;

  bool by_domain_ = false;
  std::vector<Matrix6> elasticity_;  // of every domain, or both parts of every region
};

inline const Matrix6& DomainElasticity::operator()(Index d, const StrainDomain& domain) const noexcept {
  return elasticity_[by_domain_ ? static_cast<std::size_t>(d)
                                : index(static_cast<std::size_t>(domain.region), domain.part)];
}

inline std::size_t DomainElasticity::index(std::size_t material, StrainPart part) noexcept {
  return 2 * material + (part == StrainPart::volumetric ? 1 : 0);
}

}}}  // namespace palpate::detail
