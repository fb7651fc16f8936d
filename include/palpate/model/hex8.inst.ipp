// Compiled once: set-up with Hex8.
#include <palpate/model/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_ELEMENT(, Hex8)

}}  // namespace palpate
