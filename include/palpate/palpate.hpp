// Everything a haptic session needs: meshes, scenes, materials, models, contact, session, servo and loop. Other
// features have their own headers: recording and simulated devices (device/), rendered surfaces
// (model/rendering/visual_surface.hpp), writers (io/vtu.hpp, io/pvd.hpp, io/surface_files.hpp, io/write_msh.hpp),
// refinement (mesh/refine.hpp), the energy tank (haptic/energy_tank.hpp), comparison of model compositions
// (model/static/trade_off.hpp), results (post/), cutting (cut/).
#pragma once

#include <palpate/contact/tissue_group.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_loop.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/material/tissue_presets.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/version.hpp>
