// Compiled once: set-up with MeanDilatation<Hex8>.
#include <palpate/model/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_ELEMENT(, MeanDilatation<Hex8>)

}}  // namespace palpate
