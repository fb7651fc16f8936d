// Everything that a first haptic session needs: a mesh (arrays, a Gmsh file, a box, a sphere), its scene, Tet4 and
// Smoothed<Tet4>, LinearElastic, HapticFEModel on linear statics, the tools, session, servo, loop, and a mock device.
// What else a scene needs is behind a header of its own, so that no program compiles what it does not use:
//   - elements.hpp: hexahedra and quadratic elements
//   - materials.hpp: linear materials with a direction, presets of tissues
//   - soft.hpp: large strain and motion
//   - cut.hpp: tissue that is cut
//   - tools.hpp: several tissues
//   - io.hpp: other mesh files, results
//   - advice.hpp: accuracy and suggestions
//   - testing.hpp: laws for types of your own
//   - own_types.hpp: with palpate::compiled, types of your own
// and in folders: recording, simulated devices and adapters (device/), the surface to draw
// (model/rendering/visual_surface.hpp), refinement (mesh/), the energy tank (haptic/energy_tank.hpp), stresses (post/).
#pragma once

#include <palpate/device/mock_device.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/io/read_msh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/version.hpp>
