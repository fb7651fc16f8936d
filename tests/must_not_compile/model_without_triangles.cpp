// expect: palpate: tools touch triangles
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

using namespace palpate;

struct FlatFace : Tri3 {
#ifndef PALPATE_GOOD_TWIN
  static constexpr int triangles = 1;  // not a list
#endif
};

struct Mine : Tet4 {
  using Face = FlatFace;
};

using Model = HapticFEModel<Mine, LinearElastic>;

const SetupReport& report(const Model& model) {
  return model.report();
}
