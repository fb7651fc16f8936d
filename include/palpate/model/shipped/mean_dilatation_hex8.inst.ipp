// Compiled once: set-up with MeanDilatation<Hex8>.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_MEAN_DILATATION_HEX8()

}}  // namespace palpate
