// expect: deleted
// The servo refers to its tissue: one that is destroyed at the end of the statement is refused.
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

using Model = HapticFEModel<Tet4, LinearElastic>;
Model make_model();

#ifdef PALPATE_GOOD_TWIN
static_assert(std::is_constructible_v<HapticServo, Model&, SphereTool>);
#else
HapticServo servo(make_model(), SphereTool{4e-3});
#endif
