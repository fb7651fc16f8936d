// All tools and TissueGroup, which palpate.hpp has, too: sphere, capsule, ConvexTool, BladeTool, and grasps. Their code
// is compiled only where they are used.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/tools.hpp>
