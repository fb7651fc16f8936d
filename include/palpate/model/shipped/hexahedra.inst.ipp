// Compiled once: set-up with hexahedra.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_HEX8()
PALPATE_SHIPPED_HEX20()
PALPATE_SHIPPED_MEAN_DILATATION_HEX8()

}}  // namespace palpate
