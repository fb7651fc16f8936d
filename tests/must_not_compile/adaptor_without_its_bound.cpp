// expect: this tissue changes the compliance that it inherits
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/static/linear_tissue.hpp>

using namespace palpate;

/// Twice as soft as the tissue, with its own revision and floor; the good twin also has its own bound.
struct Softer : TissueAdaptor<LinearTissue<double>> {
  using TissueAdaptor::TissueAdaptor;
  Matrix3 compliance(int i, int j) const noexcept { return 2.0 * tissue().compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return tissue().compliance_revision(); }
  double compliance_floor() const noexcept { return 2.0 * tissue().compliance_floor(); }
#ifdef PALPATE_GOOD_TWIN
  double compliance_bound(int j) const noexcept {
    return 2.0 * tissue().compliance_bound(j);
  }
#endif
};

void touch(LinearTissue<double>& organ) {
  Softer softer(organ);
  HapticServo servo(softer, SphereTool{4e-3});
}
