// Compiled once: set-up with Smoothed<Tet4>.
#include <palpate/model/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_ELEMENT(, Smoothed<Tet4>)

}}  // namespace palpate
