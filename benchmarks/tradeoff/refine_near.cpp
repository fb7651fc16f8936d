// Refines a mesh near the spheres.
#include <queue>
#include <set>
#include <unordered_map>

#include "scene.hpp"

namespace tradeoff {
namespace {

/// Bisects tetrahedra at an edge, together with all others around it, so that the mesh stays conforming.
class Bisection {
 public:
  explicit Bisection(const Mesh<Tet4>& mesh) : mesh_(mesh) {
    mesh_.regions.resize(mesh.elements.size(), 0);
    for (std::size_t e = 0; e < mesh_.elements.size(); ++e) enter(e);
  }

  /// Bisects edges longer than wanted(middle), the longest first.
  template <class Wanted>
  void refine(Wanted wanted) {
    using Item = std::pair<double, Edge>;
    std::priority_queue<Item> queue;
    const auto push = [&](const Edge& e) {
      if (const double length = length_of(e); length > wanted(middle_of(e))) queue.push({length, e});
    };
    for (const auto& [edge, around] : around_) push(edge);
    while (!queue.empty()) {
      const Edge wish = queue.top().second;
      queue.pop();
      while (around_.contains(wish)) {
        Edge edge = wish;  // follows the longest edge of all elements around it (Rivara's propagation path)
        for (Edge longer = longest_round(edge); longer != edge; longer = longest_round(edge)) edge = longer;
        for (const Edge& fresh : cut(edge)) push(fresh);
      }
    }
  }

  /// The refined mesh, with the groups of faces of `coarse` refined too.
  Mesh<Tet4> take(const Mesh<Tet4>& coarse) {
    mesh_.groups = {};
    for (const Group& g : coarse.groups.all()) {
      Group& fine = mesh_.groups.get_or_add(g.name, g.dimension);
      fine.nodes = g.nodes;
      for (const auto& face : g.faces) cut_face({face[0], face[1], face[2]}, fine);
    }
    mesh_.groups.tidy();
    return std::move(mesh_);
  }

 private:
  using Edge = std::pair<NodeId, NodeId>;
  struct Hash {
    std::size_t operator()(const Edge& e) const noexcept {
      return std::hash<std::uint64_t>()((static_cast<std::uint64_t>(e.first) << 32) ^
                                        static_cast<std::uint64_t>(e.second));
    }
  };
  static Edge edge_of(NodeId a, NodeId b) { return std::minmax(a, b); }
  double length_of(const Edge& e) const { return (mesh_.position(e.first) - mesh_.position(e.second)).norm(); }
  Vector3 middle_of(const Edge& e) const { return 0.5 * (mesh_.position(e.first) + mesh_.position(e.second)); }

  template <class Visit>
  void for_each_edge(std::size_t e, Visit visit) const {
    const auto nodes = mesh_.elements[e];
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = a + 1; b < 4; ++b) visit(edge_of(nodes[a], nodes[b]));
  }
  void enter(std::size_t e) {
    for_each_edge(e, [&](const Edge& edge) { around_[edge].insert(e); });
  }
  void leave(std::size_t e) {
    for_each_edge(e, [&](const Edge& edge) {
      const auto it = around_.find(edge);
      it->second.erase(e);
      if (it->second.empty()) around_.erase(it);
    });
  }
  Edge longest_round(const Edge& edge) const {
    std::pair<double, Edge> longest{length_of(edge) * (1.0 + 1e-9), edge};
    for (const std::size_t e : around_.at(edge))
      for_each_edge(e, [&](const Edge& other) { longest = std::max(longest, {length_of(other), other}); });
    return longest.second;
  }
  std::vector<Edge> cut(const Edge& edge) {
    const auto middle = static_cast<NodeId>(mesh_.positions.size());
    mesh_.positions.push_back(middle_of(edge));
    middles_[edge] = middle;
    std::set<Edge> fresh;
    const std::set<std::size_t> around = around_.at(edge);
    for (const std::size_t e : around) {
      leave(e);
      auto other = mesh_.elements[e];
      for (NodeId& n : mesh_.elements[e])
        if (n == edge.first) n = middle;
      for (NodeId& n : other)
        if (n == edge.second) n = middle;
      mesh_.elements.push_back(other);
      mesh_.regions.push_back(mesh_.regions[e]);
      for (const std::size_t part : {e, mesh_.elements.size() - 1}) {
        enter(part);
        for_each_edge(part, [&](const Edge& x) {
          if (x.first == middle || x.second == middle) fresh.insert(x);
        });
      }
    }
    return {fresh.begin(), fresh.end()};
  }
  void cut_face(const std::array<NodeId, 3>& face, Group& group) const {
    // Several edges of a face may have been bisected: the first one has the middle node with the smallest id.
    NodeId first = -1;
    std::size_t at = 0;
    for (std::size_t i = 0; i < 3; ++i)
      if (const auto it = middles_.find(edge_of(face[i], face[(i + 1) % 3]));
          it != middles_.end() && (first < 0 || it->second < first)) {
        first = it->second;
        at = i;
      }
    if (first < 0) {
      group.faces.push_back({face.begin(), face.end()});
      return;
    }
    group.nodes.push_back(first);
    const NodeId a = face[at], b = face[(at + 1) % 3], c = face[(at + 2) % 3];
    cut_face({a, first, c}, group);
    cut_face({first, b, c}, group);
  }

  Mesh<Tet4> mesh_;
  std::unordered_map<Edge, std::set<std::size_t>, Hash> around_;
  std::unordered_map<Edge, NodeId, Hash> middles_;
};

}  // namespace

Mesh<Tet4> refine_near(const PressScene& scene, double edge) {
  Bisection bisection(scene.mesh);
  bisection.refine([&](const Vector3& p) {
    double distance = infinity;
    for (const Sphere& b : scene.spheres) distance = std::min(distance, (p - b.point).norm());
    return edge + 0.35 * distance;
  });
  return bisection.take(scene.mesh);
}

}  // namespace tradeoff
