// Include next to palpate.hpp for Jaws, two tools on a joint. All other tools and TissueGroup are in palpate.hpp:
// sphere, capsule, ConvexTool, BladeTool, and grasps; their code is compiled only where they are used.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/tools.hpp>
#include <palpate/haptic/jaws.hpp>
#include <palpate/haptic/trocar.hpp>
