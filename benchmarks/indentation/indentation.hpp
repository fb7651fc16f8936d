// Shared by the two parts of the program: graded boxes of tissue and a sphere rigidly coupled to the device.
#pragma once

#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>

#include <algorithm>
#include <memory>

namespace indentation {

inline constexpr double sphere_radius = 4e-3;   ///< [m]
inline constexpr double youngs_modulus = 10e3;  ///< [Pa]

/// Part 1: presses into a bonded layer of elements E and compares with the exact solution. False when the acceptance
/// fails. Defined in layer.hpp, compiled in a file per element.
template <palpate::Element E>
bool force_converges(const char* element);
/// Part 2: slides over a flat block at constant depth and measures the ripple. False when the acceptance fails.
bool sliding_is_smooth();

/// Distances from 0 to exactly `total`: steps of about `h` up to `fine`, then each `growth` times the one before.
inline std::vector<double> graded(double h, double fine, double total, double growth) {
  std::vector<double> x{0.0};
  double step = h;
  std::size_t even = 0;
  while (x.back() < total * (1.0 - 1e-9)) {
    if (x.back() < fine - 1e-9 * h)
      even = x.size();
    else
      step *= growth;
    x.push_back(x.back() + step);
  }
  const double kept = even + 1 < x.size() ? x[even] : 0.0, stretch = (total - kept) / (x.back() - kept);
  for (double& v : x)
    if (v > kept) v = kept + (v - kept) * stretch;
  return x;
}

/// Node heights of a block that is fine at its top.
inline std::vector<double> graded_down(double h, double fine, double height, double growth) {
  std::vector<double> z = graded(h, fine, height, growth);
  for (double& v : z) v = height - v;
  std::ranges::reverse(z);
  return z;
}

/// Nodes of the top side for which near(position) is true.
template <palpate::Element E, class Near>
std::vector<palpate::NodeId> top_nodes(const palpate::Mesh<E>& mesh, Near near) {
  std::vector<palpate::NodeId> nodes;
  for (palpate::NodeId node : mesh.find_group("z1")->nodes)
    if (near(mesh.position(node))) nodes.push_back(node);
  return nodes;
}

/// A tissue and a sphere that follows the device exactly; the limits of the gate are too high to act.
template <palpate::Element E>
struct Session {
  using Model = palpate::HapticFEModel<E, palpate::LinearElastic>;

  Model model;
  palpate::HapticServo servo;
  palpate::ToolState state;
  palpate::Status status;

  Session(const palpate::Mesh<E>& mesh, const palpate::Scene& scene, double poisson_ratio)
      : model(mesh, scene, palpate::LinearElastic{.youngs_modulus = youngs_modulus, .poisson_ratio = poisson_ratio}),
        servo(model, palpate::SphereTool{sphere_radius}, options()) {}

  /// One tick with the centre of the sphere at `centre`. Returns the contact force before the gate.
  palpate::Vector3 tick(const palpate::Vector3& centre) {
    state.time += 1e-3;
    state.position = centre;
    status = servo.tick({&state, 1}).front().status;
    return servo.tick_view().contact_force();
  }
  int pressing() const { return static_cast<int>(servo.tick_view().contacts().size()); }
  bool has(palpate::StatusFlag flag) const { return status.has(flag); }

 private:
  static palpate::ServoOptions options() {
    palpate::ServoOptions o;
    o.coupling_stiffness = palpate::infinity;
    o.force_limits = palpate::ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
    return o;
  }
};

}  // namespace indentation
