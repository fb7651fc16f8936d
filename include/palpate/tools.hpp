// Include next to palpate.hpp for several tissues that one tool touches. All tools are in palpate.hpp: sphere, capsule,
// ConvexTool, BladeTool, and grasps; their code is compiled only where they are used.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/tools.hpp>
