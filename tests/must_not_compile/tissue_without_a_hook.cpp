// expect: this tissue has no hook begin_tick() noexcept
// A class that wraps a tissue and forwards only some hooks: steps and cuts of the tissue would be lost.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/model/static/linear_tissue.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
struct Watched : TissueAdaptor<LinearTissue<double>> {
  using TissueAdaptor::TissueAdaptor;
#else
struct Watched {
  explicit Watched(LinearTissue<double>& tissue) : inner(tissue) {}
  LinearTissue<double>& tissue() noexcept { return inner; }
  const ContactSurface& contact_surface() const noexcept { return inner.contact_surface(); }
  Matrix3 compliance(int i, int j) const noexcept { return inner.compliance(i, j); }
  std::uint64_t compliance_revision() const noexcept { return inner.compliance_revision(); }
  double compliance_bound(int j) const noexcept { return inner.compliance_bound(j); }
  double compliance_floor() const noexcept { return inner.compliance_floor(); }
  const Eigen::Isometry3d& to_world() const noexcept { return inner.to_world(); }
  void prefetch(std::span<const int> vertices) noexcept { inner.prefetch(vertices); }
  LinearTissue<double>& inner;
#endif
  Status require_columns(std::span<const int> vertices) noexcept {
    ++asked;
    return tissue().require_columns(vertices);
  }
  int asked = 0;
};

void touch(LinearTissue<double>& organ) {
  Watched watched(organ);
  HapticServo servo(watched, SphereTool{4e-3});
}
