// Compiled once: set-up with Hex8.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_HEX8()

}}  // namespace palpate
