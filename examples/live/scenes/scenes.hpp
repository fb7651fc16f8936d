// All scenes.
#pragma once

#include "../core/touch_scene.hpp"

namespace live {

TouchScene palpate_scene();
TouchScene retract_scene();
TouchScene grasp_scene();
TouchScene cut_scene();
TouchScene beating_scene();

/// The nodes of boundary triangles that face downwards: the surface on which an organ lies.
std::vector<NodeId> facing_down(const Mesh<Tet4>& mesh);

}  // namespace live
