// expect: not a tissue: it needs contact_surface() const
#include <palpate/contact/tissue_group.hpp>
#include <palpate/device/mock_device.hpp>
#include <palpate/haptic/haptic_session.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Touched = TissueGroup;
#else
using Touched = SphereTool;
#endif

void touch(MockDevice<>& device, Touched& touched) {
  HapticSession session(device, touched, SphereTool{4e-3});
}
