// Cutting of tissue while it is touched, in addition to palpate.hpp: HapticFEModel on Cuttable<...>, its rendered
// surface, and the background thread that computes the cuts.
#pragma once

#include <palpate/cut/cuttable.hpp>
#include <palpate/haptic/background_worker.hpp>
