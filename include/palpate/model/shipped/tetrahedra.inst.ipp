// Compiled once: set-up with tetrahedra.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_TET4()
PALPATE_SHIPPED_TET10()
PALPATE_SHIPPED_SMOOTHED_TET4()

}}  // namespace palpate
