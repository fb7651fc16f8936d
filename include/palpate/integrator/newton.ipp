// Definitions of newton.hpp.
#pragma once

#include <palpate/integrator/newton.hpp>
#include <palpate/core/setup_error.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void NewtonParameters::require_usable() const {
  const auto refuse = [](const char* name, const std::string& value, const char* hint) {
    raise(SetupErrorKind::bad_argument, std::string("Newton's ") + name + " is " + value, hint);
  };
  if (maximum_iterations < 1) refuse("maximum_iterations", std::to_string(maximum_iterations), "Give at least 1");
  if (!(tolerance >= 0.0 && tolerance < 1.0))
    refuse("tolerance", number(tolerance), "Give 0 or a small positive number below 1");
  if (maximum_halvings < 0) refuse("maximum_halvings", std::to_string(maximum_halvings), "Give 0 or more");
}

PALPATE_INLINE NewtonMethod::NewtonMethod(Index size, const NewtonParameters& parameters)
    : parameters_(parameters), residual_(size), step_(size), trial_(size), trial_residual_(size) {
  parameters_.require_usable();
}

}}  // namespace palpate
