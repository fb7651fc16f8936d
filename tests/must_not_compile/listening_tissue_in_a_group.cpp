// expect: a TissueGroup forwards no hook but prefetch
// The group would not pass the forces to its member, which would never stiffen.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/tissue_group.hpp>

using namespace palpate;

struct Listening : TissueAdaptor<TissueGroup> {
  using TissueAdaptor::TissueAdaptor;
#ifndef PALPATE_GOOD_TWIN
  void end_tick(std::span<const VertexForce> forces, std::span<const PointForce>) noexcept {
    pressed = forces.size();
  }
#endif
  std::size_t pressed = 0;
};

TissueGroup group_of(Listening& listening) {
  return TissueGroup(listening);
}
