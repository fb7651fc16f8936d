// Include next to palpate.hpp for linear materials with a direction, and for start values of tissues. Large strain:
// soft.hpp.
#pragma once

#include <palpate/material/orthotropic.hpp>
#include <palpate/material/tissue_presets.hpp>
