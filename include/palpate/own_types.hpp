// For palpate::compiled with user-defined elements, materials, solvers or meshes: definitions of the templates that
// take them. Include it in addition to palpate.hpp, in any order. In header-only use it adds nothing.
#pragma once

#include <palpate/model/haptic_fe_model.tpp>
