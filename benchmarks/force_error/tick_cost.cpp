#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>

#include "cell.hpp"

namespace force_error {
namespace {

using Model = HapticFEModel<Smoothed<Tet4>, LinearElastic>;

double percentile(std::vector<double> values, double part) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(part * static_cast<double>(values.size() - 1))];
}

/// Nanoseconds per tick of a sphere that slides in a circle over the block, in batches of ten ticks. The first circle
/// is not recorded: there the columns of the compliance are computed.
class Slide {
 public:
  Slide(Model& model, double radius, double depth)
      : servo_(model, SphereTool{radius}), radius_(radius), depth_(depth) {}

  void batch() {
    constexpr int ticks = 10;
    const auto start = std::chrono::steady_clock::now();
    for (int i = 0; i < ticks; ++i, ++count_) {
      const double angle = 1e-3 * count_;
      state_.time += 1e-3;
      state_.position = {0.05 + 0.02 * std::cos(angle), 0.05 + 0.02 * std::sin(angle), 0.08 + radius_ - depth_};
      servo_.tick(state_);
      contacts_ += static_cast<long>(servo_.tick_view().contacts().size());
    }
    const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - start;
    if (1e-3 * count_ > 6.3) nanoseconds_.push_back(passed.count() / ticks);
  }
  const std::vector<double>& nanoseconds() const { return nanoseconds_; }
  double mean_contacts() const { return static_cast<double>(contacts_) / count_; }

 private:
  HapticServo servo_;
  ToolState state_;
  double radius_, depth_;
  int count_ = 0;
  long contacts_ = 0;
  std::vector<double> nanoseconds_;
};

}  // namespace

void print_tick_cost() {
  const auto mesh = copy_mesh<Smoothed<Tet4>>(box_tet4(Vector3(0.1, 0.1, 0.08), {16, 16, 12}));
  std::printf("\ntime of a tick without and with the error bar, in turn, batches of ten [ns]\n");
  for (const double radius : {8e-3, 20e-3, 40e-3}) {
    Scene scene;
    scene.fix("z0").touch("z1", {.radius = radius});
    const LinearElastic material{.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1000.0};
    Model plain(mesh, scene, material), barred(mesh, scene, material, {.force_error = measured_force_error()});
    Slide without(plain, radius, radius / 8.0), with(barred, radius, radius / 8.0);
    for (int i = 0; i < 5000; ++i)  // each is first in turn
      for (Slide* slide : i % 2 == 0 ? std::array{&without, &with} : std::array{&with, &without}) slide->batch();
    const std::vector<double>&a = without.nanoseconds(), &b = with.nanoseconds();
    std::vector<double> added;
    for (std::size_t i = 0; i < a.size(); ++i) added.push_back(b[i] - a[i]);
    std::printf(
        "  radius %2.0f mm, %4.1f contacts: p50 %.0f and %.0f, p99 %.0f and %.0f, difference of pairs p50 %+.0f\n",
        1e3 * radius, with.mean_contacts(), percentile(a, 0.5), percentile(b, 0.5), percentile(a, 0.99),
        percentile(b, 0.99), percentile(added, 0.5));
  }
}

}  // namespace force_error
