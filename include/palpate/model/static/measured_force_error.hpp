// The option with which a static model measures how far contact forces are in error because of the mesh.
#pragma once

#include <palpate/model/force_error_options.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// For SetupOptions::force_error of a static model whose scene names the radius of the sphere that touches
/// (TouchOptions). The set-up then presses that sphere at some places of the touchable surface, far from each other,
/// into the tissue and into a reference on a finer mesh (detail/measure_force_error.hpp): SetupReport::accuracy has the
/// result, and HapticServo::force_error gives an error bar in every tick. Costs about as much as the set-up of a model
/// with 1000 more nodes per place. Throws bad_argument for less than one place.
ForceErrorOptions measured_force_error(int places = 3);

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/measured_force_error.ipp>
#endif
