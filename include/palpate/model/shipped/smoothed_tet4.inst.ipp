// Compiled once: set-up with Smoothed<Tet4>.
#include <palpate/model/shipped/shipped.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_SHIPPED_SMOOTHED_TET4()

}}  // namespace palpate
