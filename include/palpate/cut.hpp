// Include next to palpate.hpp for tissue that is cut while it is touched: HapticFEModel on Cuttable<...>, its visual
// surface, detached pieces, also as bodies that move, and the thread that applies the cuts.
#pragma once

#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/detached_piece.hpp>
#include <palpate/cut/moving_pieces.hpp>
#include <palpate/haptic/background_worker.hpp>
