#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include "catch.hpp"

#include <numeric>

/// A block of any element under a sphere, defined once; each element is compiled in a separate file.
namespace test {

using namespace palpate;

/// 30 x 30 x 20 mm, fixed below, touched above.
template <Element E>
auto touch_block() {
  const Vector3 size(0.03, 0.03, 0.02);
  if constexpr (E::nodes == 4)
    return box_tet4(size, {8, 8, 4});
  else if constexpr (E::nodes == 8)
    return box_hex8(size, {8, 8, 4});
  else if constexpr (E::nodes == 10)
    return box_tet10(size, {4, 4, 2});
  else
    return box_hex20(size, {4, 4, 2});
}

/// The compliance between two contact points agrees with the displacement of the whole body under a force distributed
/// by the contact weights, and is symmetric.
template <class Model>
void check_weights_both_ways(Model& model) {
  const ContactSurface& surface = model.contact_surface();
  const detail::ContactSamples samples(surface, 2e-3);
  std::vector<int> all(static_cast<std::size_t>(surface.vertex_count()));
  std::iota(all.begin(), all.end(), 0);
  REQUIRE(model.require_columns(all) == Status{});
  const auto compliance = [&](const detail::ContactSample& i, const detail::ContactSample& j) {
    Matrix3 w = Matrix3::Zero();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b)
        w += i.weights[a] * j.weights[b] * Matrix3(model.compliance(i.vertices[a], j.vertices[b]));
    return w;
  };
  const Vector3 force(0.1, -0.2, -0.5);
  VectorX u(3 * model.mesh().node_count());
  for (int j = 0; j < samples.count(); j += 97) {
    std::array<VertexForce, 3> spread;
    for (std::size_t b = 0; b < 3; ++b)
      spread[b] = {samples[j].vertices[b], ModelVector(samples[j].weights[b] * force)};
    model.displacement_with(spread, u);
    for (int i = 0; i < samples.count(); i += 61) {
      Vector3 read = Vector3::Zero();
      for (std::size_t a = 0; a < 3; ++a) {
        const NodeId node = model.touchable_nodes()[static_cast<std::size_t>(samples[i].vertices[a])];
        read += samples[i].weights[a] * u.template segment<3>(3 * Index{node});
      }
      const Matrix3 w = compliance(samples[i], samples[j]);
      CHECK((w * force - read).norm() <= 1e-10 * u.cwiseAbs().maxCoeff());
      CHECK((w - compliance(samples[j], samples[i]).transpose()).norm() <= 1e-10 * w.norm());
    }
  }
}

/// Pressing: the force points outwards and grows with depth as in Hertz's theory.
template <class Model>
void check_press(Model& model) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  ForceLimits limits;
  limits.peak_force = 1e3;
  limits.slew_rate = 1e9;
  limits.ramp_time = 1e-9;
  options.force_limits = limits;
  constexpr double radius = 8e-3;
  HapticServo servo(model, SphereTool{.radius = radius}, options);
  double last = 0.0, time = 0.0;
  for (int step = -20; step <= 100; ++step) {
    ToolState state;
    state.position = Vector3(0.015, 0.015, 0.02 + radius - 1.5e-5 * step);
    state.time = time += 1e-3;
    const GatedForce got = servo.tick({&state, 1})[0];
    REQUIRE(got.force().allFinite());
    if (step < 0) CHECK(got.force().norm() == 0.0);
    if (step % 25 == 0 && step > 0) {
      CHECK(got.force()[2] > 1.3 * last);  // Hertz: the power 3/2 of the depth
      CHECK(got.force().head<2>().norm() <= 0.05 * got.force()[2]);
      last = got.force()[2];
    }
  }
  // Hertz on a half space at the last depth; a bonded layer of 20 mm is stiffer, a coarse one much so.
  const LinearElastic tissue{1e4, 0.3, 0.0};
  const double hertz = 4.0 / 3.0 * tissue.youngs_modulus / (1.0 - 0.09) * std::sqrt(radius) * std::pow(1.5e-3, 1.5);
  CHECK(last > hertz);
  CHECK(last < 1.8 * hertz);
}

template <Element E>
void check_touch() {
  HapticFEModel<E, LinearElastic, Condensed<SelectiveInverse>> model(touch_block<E>(), Scene().fix("z0").touch("z1"),
                                                                     LinearElastic{1e4, 0.3, 0.0});
  CHECK(model.contact_surface().vertex_count() == static_cast<int>(touch_block<E>().find_group("z1")->nodes.size()));
  check_weights_both_ways(model);
  check_press(model);
}

}  // namespace test
