// Include next to palpate.hpp for tools with corners, hulls of their own meshes, grasps, and several tissues that one
// tool touches.
#pragma once

#include <palpate/contact/convex_hull.hpp>
#include <palpate/contact/tissue_group.hpp>
#include <palpate/contact/tools.hpp>
