// expect: deleted
// A copy would restore the mode twice.
#include <palpate/core/platform.hpp>

using namespace palpate;

void tick() {
  const FlushDenormals flush;
#ifndef PALPATE_GOOD_TWIN
  const FlushDenormals copy = flush;
#endif
}
