// Distance of a point to what a mesh is refined near.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/mesh/detail/simplex_tree.hpp>
#include <palpate/mesh/refine_near.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Distance to the nearest of several targets.
class TargetDistance {
 public:
  /// `step` is a length from which distances to sets of points are searched upwards, `reach` the largest distance of
  /// interest [m]. Throws what refine_near throws for targets.
  TargetDistance(const Mesh<Tet4>& mesh, const std::vector<RefineTarget>& targets, double step, double reach);

  /// Infinite beyond `reach` [m]; to sets of points accurate to a thousandth.
  double operator()(const Vector3& p) const;

 private:
  SimplexTree tree_;
  std::vector<where::PointSet> sets_;
  double step_, reach_;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/mesh/detail/target_distance.ipp>
#endif
