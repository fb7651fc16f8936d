// Compiled once: set-up with Tet10.
#include <palpate/model/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_ELEMENT(, Tet10)

}}  // namespace palpate
