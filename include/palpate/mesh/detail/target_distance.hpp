// Distance of a point to what a mesh is refined near.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/detail/simplex_tree.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/refine_target.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Distance to the nearest of several targets.
class TargetDistance {
 public:
  /// Throws what refine_near throws for targets.
  TargetDistance(const Mesh<Tet4>& mesh, const std::vector<RefineTarget>& targets);

  /// Infinite beyond `reach` [m]; to sets of points accurate to a thousandth of `reach`.
  double operator()(const Vector3& p, double reach) const;

 private:
  SimplexTree tree_;
  std::vector<where::PointSet> sets_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/target_distance.ipp>
#endif
