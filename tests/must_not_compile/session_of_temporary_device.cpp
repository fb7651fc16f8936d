// expect: deleted
// A session refers to its devices: one that is destroyed at the end of the statement is refused.
#include <palpate/device/mock_device.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_session.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

using Model = HapticFEModel<Tet4, LinearElastic>;
Model& model();

#ifdef PALPATE_GOOD_TWIN
static_assert(std::is_constructible_v<HapticSession, MockDevice<>&, Model&, SphereTool>);
#else
HapticSession session(MockDevice(trajectory::poke()), model(), SphereTool{4e-3});
#endif
