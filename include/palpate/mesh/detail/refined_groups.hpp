// Groups of a mesh whose edges were divided.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/bisection.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <array>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The nodes in the middle of divided edges, by edge.
class DividedEdges {
 public:
  DividedEdges(std::span<const NodePair> divided, NodeId first_new_node)
      : divided_(divided), first_new_(first_new_node) {
    sorted_.reserve(divided.size());
    for (const NodePair& edge : divided) sorted_.emplace_back(edge, first_new_node++);
    std::ranges::sort(sorted_);
  }

  /// The node in the middle of an edge; -1 if it was not divided.
  NodeId middle(NodeId a, NodeId b) const noexcept {
    const auto it = std::ranges::lower_bound(sorted_, node_pair(a, b), {}, &std::pair<NodePair, NodeId>::first);
    return it != sorted_.end() && it->first == node_pair(a, b) ? it->second : -1;
  }
  /// Adds the triangles that replace `face`, with the same orientation.
  void divide_face(const std::array<NodeId, 3>& face, std::vector<std::array<NodeId, 3>>& parts) const;
  /// Sets `is_in` of the new nodes on edges of the coarse mesh both of whose nodes are in, and on parts of these edges.
  void divide_lines(const Mesh<Tet4>& coarse, std::vector<char>& is_in) const;
  std::size_t count() const noexcept { return divided_.size(); }

 private:
  std::span<const NodePair> divided_;
  NodeId first_new_ = 0;
  std::vector<std::pair<NodePair, NodeId>> sorted_;
};

inline void DividedEdges::divide_face(const std::array<NodeId, 3>& face,
                                      std::vector<std::array<NodeId, 3>>& parts) const {
  // Where several edges were divided, the first was the one whose new node has the smallest id.
  NodeId first = -1;
  std::size_t side = 0;
  for (std::size_t i = 0; i < 3; ++i)
    if (const NodeId m = middle(face[i], face[(i + 1) % 3]); m >= 0 && (first < 0 || m < first)) {
      first = m;
      side = i;
    }
  if (first < 0) {
    parts.push_back(face);
    return;
  }
  const NodeId a = face[side], b = face[(side + 1) % 3], c = face[(side + 2) % 3];
  divide_face({a, first, c}, parts);
  divide_face({first, b, c}, parts);
}

inline void DividedEdges::divide_lines(const Mesh<Tet4>& coarse, std::vector<char>& is_in) const {
  std::set<NodePair> lines;
  const auto contains = [&](NodeId i) { return is_in[static_cast<std::size_t>(i)] != 0; };
  for (const auto& element : coarse.elements)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (contains(element[a]) && contains(element[b])) lines.insert(node_pair(element[a], element[b]));
  NodeId next = first_new_;
  for (const auto& [a, b] : divided_) {
    const NodeId m = next++;
    if (!lines.contains({a, b})) continue;
    is_in[static_cast<std::size_t>(m)] = 1;
    lines.insert({node_pair(a, m), node_pair(b, m)});
  }
}

/// Transfers groups one by one; what several of them need is computed once.
class GroupRefinement {
 public:
  GroupRefinement(const Mesh<Tet4>& coarse, const DividedEdges& divided, const Bisection::Elements& fine)
      : coarse_(&coarse), divided_(&divided), fine_(&fine) {}

  void refine(Group& group) {
    const bool is_set_of_nodes = group.faces.empty() && group.elements.empty();
    is_in_.assign(coarse_->positions.size() + divided_->count(), 0);
    for (const NodeId i : group.nodes) add(i);
    if (group.dimension == 1) divided_->divide_lines(*coarse_, is_in_);
    if (is_set_of_nodes && group.dimension != 1) divide_nodes(group);
    divide_faces(group);
    divide_elements(group);
    group.nodes.clear();
    for (std::size_t i = 0; i < is_in_.size(); ++i)
      if (is_in_[i] != 0) group.nodes.push_back(static_cast<NodeId>(i));
  }

 private:
  void add(NodeId i) { is_in_[static_cast<std::size_t>(i)] = 1; }
  bool contains(NodeId i) const { return is_in_[static_cast<std::size_t>(i)] != 0; }

  void divide_faces(Group& group) {
    std::vector<std::array<NodeId, 3>> parts;
    for (const auto& face : group.faces) {
      if (face.size() != 3 || !is_face({face[0], face[1], face[2]}))
        raise(SetupErrorKind::unsupported, "group '" + group.name + "' has a face that is not a face of an element",
              "Remove it before refinement");
      divided_->divide_face({face[0], face[1], face[2]}, parts);
    }
    group.faces.clear();
    for (const auto& part : parts) {
      group.faces.emplace_back(part.begin(), part.end());
      std::ranges::for_each(part, [&](NodeId i) { add(i); });
    }
  }

  void divide_elements(Group& group) {
    std::vector<Index> parts;
    for (const Index e : group.elements) add_parts(e, &parts);
    group.elements = std::move(parts);
  }

  void divide_nodes(const Group& group) {
    const auto is_given = [&](NodeId i) { return contains(i); };
    const bool is_solid = std::ranges::any_of(group.nodes, [&](NodeId i) { return is_inside(i); });
    std::vector<std::array<NodeId, 3>> parts;
    for (const BoundaryFace& face : boundary())
      if (std::ranges::all_of(face.nodes, is_given))
        divided_->divide_face({face.nodes[0], face.nodes[1], face.nodes[2]}, parts);
    for (const auto& part : parts) std::ranges::for_each(part, [&](NodeId i) { add(i); });
    for (Index e = 0; is_solid && e < coarse_->element_count(); ++e)
      if (std::ranges::all_of(coarse_->elements[static_cast<std::size_t>(e)], is_given)) add_parts(e, nullptr);
  }

  /// Adds the nodes of the parts of an element to the group, and the parts to `elements`.
  void add_parts(Index e, std::vector<Index>* elements) {
    for (Index part = fine_->first[static_cast<std::size_t>(e)]; part < fine_->first[static_cast<std::size_t>(e) + 1];
         ++part) {
      std::ranges::for_each(fine_->elements[static_cast<std::size_t>(part)], [&](NodeId i) { add(i); });
      if (elements != nullptr) elements->push_back(part);
    }
  }

  bool is_face(const std::array<NodeId, 3>& face) {
    if (star_.empty()) {
      star_.resize(coarse_->positions.size());
      for (const auto& element : coarse_->elements)
        for (const NodeId i : element) star_[static_cast<std::size_t>(i)].push_back(&element);
    }
    if (std::ranges::any_of(face, [&](NodeId i) { return i < 0 || i >= coarse_->node_count(); })) return false;
    return std::ranges::any_of(star_[static_cast<std::size_t>(face[0])], [&](const auto* element) {
      return std::ranges::all_of(face, [&](NodeId i) { return std::ranges::find(*element, i) != element->end(); });
    });
  }

  const std::vector<BoundaryFace>& boundary() {
    if (!boundary_) {
      boundary_ = extract_boundary<Tet4>(*coarse_);
      is_on_boundary_.assign(coarse_->positions.size(), 0);
      for (const NodeId i : nodes_of(*boundary_)) is_on_boundary_[static_cast<std::size_t>(i)] = 1;
    }
    return *boundary_;
  }
  bool is_inside(NodeId i) {
    boundary();
    return is_on_boundary_[static_cast<std::size_t>(i)] == 0;
  }

  const Mesh<Tet4>* coarse_;
  const DividedEdges* divided_;
  const Bisection::Elements* fine_;
  std::vector<char> is_in_;                                         ///< of every node of the fine mesh
  std::vector<std::vector<const Mesh<Tet4>::Connectivity*>> star_;  ///< elements at every node of the coarse mesh
  std::optional<std::vector<BoundaryFace>> boundary_;
  std::vector<char> is_on_boundary_;
};

/// The groups of `coarse` in the refined mesh, as described at refine_near. Throws unsupported for a face that no
/// element has.
inline GroupTable refined_groups(const Mesh<Tet4>& coarse, const DividedEdges& divided,
                                 const Bisection::Elements& fine) {
  GroupTable groups = coarse.groups;
  GroupRefinement refinement(coarse, divided, fine);
  for (Group& group : groups.all()) refinement.refine(group);
  return groups;
}

}}}  // namespace palpate::detail
