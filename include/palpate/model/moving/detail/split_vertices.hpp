// Forces on vertices that a cut has split, divided among the new vertices.
#pragma once

#include <palpate/concepts/tissue_model.hpp>

#include <functional>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A tick presses the surface of before a cut: the whole force of a vertex that the cut splits would stay on one lip.
class SplitVertices {
 public:
  SplitVertices() = default;
  /// The shares are proportional to the masses of the nodes: the area that a vertex stands for is divided like the
  /// elements around it. `parent`: per vertex the vertex that it was split from, -1 without one; the first `known`
  /// vertices are those of before. `mass` of a vertex [kg]. Allocates.
  SplitVertices(std::span<const int> parent, std::size_t known, const std::function<double(int)>& mass);

  /// The first `count` of `forces` [N] are divided; parts on new vertices are appended while there is room. Returns the
  /// new count. The sum of the forces stays.
  std::size_t divide(std::span<VertexForce> forces, std::size_t count) const noexcept;

 private:
  struct Share {
    int parent, vertex;
    double share;  // of the force on the parent
  };
  std::vector<Share> shares_;  // sorted by parent
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/split_vertices.ipp>
#endif
