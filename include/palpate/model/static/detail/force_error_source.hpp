// Input of a measurement of the error of contact forces.
#pragma once

#include <palpate/contact/contact_surface.hpp>
#include <palpate/model/detail/elastic_body.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Keeps references.
struct ForceErrorSource {
  const ElasticBody& body;
  const EssentialConditions& conditions;
  const std::vector<NodeId>& nodes;     ///< of the vertices of the touchable surface
  const ContactSurface& surface;        ///< touchable, under its loads
  Vector3 origin;                       ///< of the frame of the surface, in the frame of the tools [m]
  double radius;                        ///< of the sphere that touches [m]
  bool pinched;                         ///< whether two may press from opposite sides at once
  int places;                           ///< where it is pressed
  const std::vector<NodeId>& node_map;  ///< node of `body` for every node of the mesh as given, -1 for dropped ones
  const MeshRef* coarse;                ///< ForceErrorOptions::coarse
};

}}}  // namespace palpate::detail
