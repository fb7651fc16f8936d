// Tissue that is cut while it is touched, to be had beside palpate.hpp: HapticFEModel on Cuttable<...>, its drawn surface,
// and the thread that cuts.
#pragma once

#include <palpate/cut/cuttable.hpp>
#include <palpate/haptic/background_worker.hpp>
