// Compiled once: set-up with Hex20.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_HEX20()

}}  // namespace palpate
