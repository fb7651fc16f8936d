// expect: palpate refuses -ffast-math
// alone: an #error ends the compilation
#ifndef PALPATE_GOOD_TWIN
#define __FAST_MATH__ 1
#endif
#include <palpate/core/config.hpp>
