// All a haptic session needs. Include single headers to compile less; what looks at results has headers of its own
// (post/, model/natural_frequencies.hpp), and so have cutting (cut/cuttable_tissue.hpp, cut/cut_thread.hpp, cut/blade.hpp).
#pragma once

#include <palpate/contact/tissue_group.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/device/placement.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/replay_device.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/element/hex20.hpp>
#include <palpate/element/mean_dilatation.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/with_quadrature.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/haptic/run_haptic_loop.hpp>
#include <palpate/io/gmsh.hpp>
#include <palpate/io/pvd.hpp>
#include <palpate/io/surface_files.hpp>
#include <palpate/io/vtu.hpp>
#include <palpate/io/write_msh.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/orthotropic.hpp>
#include <palpate/material/tissue_presets.hpp>
#include <palpate/material/transversely_isotropic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <palpate/mesh/refine.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/trade_off.hpp>
#include <palpate/model/visual_surface.hpp>
#include <palpate/version.hpp>
