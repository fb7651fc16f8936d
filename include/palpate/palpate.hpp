// Everything that a first haptic session needs: a mesh (arrays, a Gmsh file, a box), its scene, Tet4 and
// Smoothed<Tet4>, LinearElastic, HapticFEModel on linear statics, spheres and capsules, session, servo, loop, and a
// mock device. What else a scene needs is behind a header of its own, so that no program compiles what it does not use:
//   elements.hpp   Hex8, Hex20, Tet10      materials.hpp  other linear laws, presets   soft.hpp     large strain,
//   motion tools.hpp      several tissues         io.hpp         other mesh files, results    cut.hpp      cutting
//   advice.hpp     accuracy, suggestions   solvers.hpp    solvers for comparisons      testing.hpp  laws for own types
#pragma once

#include <palpate/device/mock_device.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/io/read_msh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/version.hpp>
