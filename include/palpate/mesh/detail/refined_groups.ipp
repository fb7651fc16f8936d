// Definitions of refined_groups.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/refined_groups.hpp>
#include <palpate/mesh/surface.hpp>

#include <algorithm>
#include <optional>
#include <set>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE DividedEdges::DividedEdges(std::span<const NodePair> divided, NodeId first_new_node)
    : divided_(divided), first_new_(first_new_node) {
  sorted_.reserve(divided.size());
  for (const NodePair& edge : divided) sorted_.emplace_back(edge, first_new_node++);
  std::ranges::sort(sorted_);
}

PALPATE_INLINE NodeId DividedEdges::middle(NodeId a, NodeId b) const noexcept {
  const auto it = std::ranges::lower_bound(sorted_, node_pair(a, b), {}, &std::pair<NodePair, NodeId>::first);
  return it != sorted_.end() && it->first == node_pair(a, b) ? it->second : -1;
}

PALPATE_INLINE void DividedEdges::divide_face(const std::array<NodeId, 3>& face,
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

PALPATE_INLINE void DividedEdges::divide_lines(const Mesh<Tet4>& coarse, std::vector<NodeId>& nodes) const {
  std::set<NodePair> lines;
  const auto is_on_line = [&, before = nodes](NodeId i) { return std::ranges::binary_search(before, i); };
  for (const auto& element : coarse.elements)
    for (std::size_t a = 0; a < 4; ++a)
      for (std::size_t b = 0; b < a; ++b)
        if (is_on_line(element[a]) && is_on_line(element[b])) lines.insert(node_pair(element[a], element[b]));
  NodeId next = first_new_;
  for (const auto& [a, b] : divided_) {
    const NodeId m = next++;
    if (!lines.contains({a, b})) continue;
    nodes.push_back(m);
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
    std::ranges::sort(group.nodes);
    if (group.dimension == 1) divided_->divide_lines(*coarse_, group.nodes);
    if (is_set_of_nodes && group.dimension != 1) divide_nodes(group);
    divide_faces(group);
    divide_elements(group);
  }

 private:
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
      group.nodes.insert(group.nodes.end(), part.begin(), part.end());
    }
  }

  void divide_elements(Group& group) {
    std::vector<Index> parts;
    for (const Index e : group.elements) add_parts(e, group.nodes, &parts);
    group.elements = std::move(parts);
  }

  void divide_nodes(Group& group) {
    std::vector<char> is_in(coarse_->positions.size(), 0);
    for (const NodeId i : group.nodes) is_in[static_cast<std::size_t>(i)] = 1;
    const auto contains = [&](NodeId i) { return is_in[static_cast<std::size_t>(i)] != 0; };
    const bool is_solid = std::ranges::any_of(group.nodes, [&](NodeId i) { return is_inside(i); });
    std::vector<std::array<NodeId, 3>> parts;
    for (const BoundaryFace& face : boundary())
      if (std::ranges::all_of(face.nodes, contains))
        divided_->divide_face({face.nodes[0], face.nodes[1], face.nodes[2]}, parts);
    for (const auto& part : parts) group.nodes.insert(group.nodes.end(), part.begin(), part.end());
    if (!is_solid) return;
    for (Index e = 0; e < coarse_->element_count(); ++e)
      if (std::ranges::all_of(coarse_->elements[static_cast<std::size_t>(e)], contains))
        add_parts(e, group.nodes, nullptr);
  }

  void add_parts(Index e, std::vector<NodeId>& nodes, std::vector<Index>* elements) const {
    for (Index part = fine_->first[static_cast<std::size_t>(e)]; part < fine_->first[static_cast<std::size_t>(e) + 1];
         ++part) {
      const auto& corners = fine_->elements[static_cast<std::size_t>(part)];
      nodes.insert(nodes.end(), corners.begin(), corners.end());
      if (elements != nullptr) elements->push_back(part);
    }
  }

  bool is_face(std::array<NodeId, 3> face) {
    if (faces_.empty()) {
      faces_.reserve(4 * coarse_->elements.size());
      for (const auto& element : coarse_->elements)
        for (const auto& [i, j, k] : Tet4::faces)
          faces_.push_back(sorted({element[static_cast<std::size_t>(i)], element[static_cast<std::size_t>(j)],
                                   element[static_cast<std::size_t>(k)]}));
      std::ranges::sort(faces_);
    }
    return std::ranges::binary_search(faces_, sorted(face));
  }
  static std::array<NodeId, 3> sorted(std::array<NodeId, 3> face) {
    std::ranges::sort(face);
    return face;
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
  std::vector<std::array<NodeId, 3>> faces_;
  std::optional<std::vector<BoundaryFace>> boundary_;
  std::vector<char> is_on_boundary_;
};

PALPATE_INLINE GroupTable refined_groups(const Mesh<Tet4>& coarse, const DividedEdges& divided,
                                         const Bisection::Elements& fine) {
  GroupTable groups = coarse.groups;
  GroupRefinement refinement(coarse, divided, fine);
  for (Group& group : groups.all()) refinement.refine(group);
  groups.tidy();
  return groups;
}

}}}  // namespace palpate::detail
