// What the C++ blocks of the pages take for granted: the includes of palpate, and objects that a reader has by then.
// Compiled only, never linked: nothing is defined. A block's own context is in a comment before it.
#pragma once

#include "device/fakes/dhdc.hpp"
#include "device/fakes/hd.hpp"

#include <palpate/cut.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/palpate.hpp>
#include <palpate/soft.hpp>

#include <palpate/core/executor.hpp>
#include <palpate/device/recorder.hpp>
#include <palpate/device/simulated_device.hpp>
#include <palpate/haptic/energy_tank.hpp>
#include <palpate/integrator/explicit_motion.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/linear/conjugate_gradient.hpp>
#include <palpate/mesh/refine_near.hpp>
#include <palpate/mesh/selection.hpp>
#include <palpate/model/static/trade_off.hpp>
#include <palpate/post/error_estimate.hpp>

#include <iostream>

namespace page {
using namespace palpate;

using Organ = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
extern Mesh<Tet4> mesh;
extern Scene scene;
extern LinearElastic material;
extern Organ organ;
extern MockDevice device, stylus, left, right;
extern HapticServo servo;
extern HapticSession session;
}  // namespace page
