// For palpate::compiled and elements, materials, solvers or meshes of one's own: definitions of the templates that take
// them. Include it once more beside palpate.hpp, in any order. Header-only it adds nothing.
#pragma once

#include <palpate/model/haptic_fe_model.tpp>
