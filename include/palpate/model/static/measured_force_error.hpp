// The option with which a static model measures how far contact forces are in error because of the mesh.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/model/force_error_options.hpp>
#include <palpate/model/static/detail/measure_force_error.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// For SetupOptions::force_error of a static model whose scene names the radius of the sphere that touches
/// (TouchOptions). The set-up then presses that sphere at some places of the touchable surface, far from each other,
/// into the tissue and into a reference on a finer mesh (detail/measure_force_error.hpp): SetupReport::accuracy has the
/// result, and TickView::force_error gives an error bar in every tick. Costs about as much as the set-up of a model
/// with 1000 more nodes per place. Throws bad_argument for less than one place.
ForceErrorOptions measured_force_error(int places = 3);

inline ForceErrorOptions measured_force_error(int places) {
  if (places < 1)
    raise(SetupErrorKind::bad_argument, "the force error is to be measured at " + std::to_string(places) + " places",
          "Give one or more; three are typical");
  return {places, &detail::measure_force_error, nullptr};
}

}}  // namespace palpate
