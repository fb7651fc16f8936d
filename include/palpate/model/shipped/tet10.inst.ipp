// Compiled once: set-up with Tet10.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_TET10()

}}  // namespace palpate
