// A sphere sliding over a flat block at constant depth: the force should not change.
#include <cmath>
#include <cstdio>

#include "indentation.hpp"

namespace indentation {
namespace {

using namespace palpate;

constexpr double width = 30e-3, height = 15e-3;  // [m]
constexpr double depth = 1e-3, poisson_ratio = 0.3;
constexpr double allowed_ripple = 0.02;
constexpr int ticks = 1000;

struct Ripple {
  double mean = 0.0, rms = 0.0, range = 0.0, jump = 0.0, lateral = 0.0, pressing = 0.0, seconds = 0.0;
  Index dofs = 0;
  bool dropped = false;  ///< some points far from the sphere were dropped because of the capacity limit
  bool clean = true;     ///< no other status flag
};

/// Coordinates from 0 to `width`, equally spaced up to `half_fine` on both sides of the middle.
std::vector<double> across(double h, double half_fine) {
  const std::vector<double> half = graded(h, half_fine, 0.5 * width, 1.4);
  std::vector<double> x;
  for (std::size_t i = half.size(); i-- > 1;) x.push_back(0.5 * width - half[i]);
  for (double v : half) x.push_back(0.5 * width + v);
  return x;
}

std::unique_ptr<Session<Tet4>> make_block(double h) {
  const Mesh<Tet4> mesh = box_tet4(across(h, 8e-3), across(h, 4.5e-3), graded_down(h, h, height, 1.3));
  Scene scene;
  scene.fix("z0").touch(top_nodes(mesh, [&](const Vector3& p) {
    return std::abs(p.x() - 0.5 * width) < 9e-3 + h && std::abs(p.y() - 0.5 * width) < 4.5e-3 + h;
  }));
  return std::make_unique<Session<Tet4>>(mesh, scene, poisson_ratio);
}

/// Slides 10 mm in one second, oblique to the mesh, after pressing in at the start.
Ripple slide(double h) {
  const auto session = make_block(h);
  const Vector3 start(0.5 * width - 5e-3, 0.5 * width - 1.1e-3, height + sphere_radius);
  for (int i = 1; i <= 200; ++i) session->tick(start - Vector3(0.0, 0.0, depth * std::min(1.0, i / 100.0)));
  Ripple r;
  Eigen::ArrayXd force(ticks);
  for (int i = 0; i < ticks; ++i) {
    const Vector3 f = session->tick(start + Vector3(1e-5 * i, 0.23e-5 * i, -depth));
    force[i] = f.z();
    r.lateral += f.head<2>().norm() / ticks;
    r.pressing += static_cast<double>(session->pressing()) / ticks;
    r.dropped = r.dropped || session->has(StatusFlag::degraded_model);
    r.clean = r.clean && (session->status | StatusFlag::degraded_model) == Status(StatusFlag::degraded_model);
  }
  r.mean = force.mean();
  r.rms = std::sqrt((force - r.mean).square().mean()) / r.mean;
  r.range = (force.maxCoeff() - force.minCoeff()) / r.mean;
  r.jump = (force.tail(ticks - 1) - force.head(ticks - 1)).abs().maxCoeff() / r.mean;
  r.lateral /= r.mean;
  r.dofs = session->model.report().free_dofs;
  r.seconds = session->model.report().total_seconds();
  return r;
}

}  // namespace

bool sliding_is_smooth() {
  std::printf(
      "\nSliding at constant depth: R = %.0f mm, depth = %.0f mm, 10 um per tick, nu = %.2f; shares of the mean "
      "force\n",
      1e3 * sphere_radius, 1e3 * depth, poisson_ratio);
  std::printf("  %-5s %7s %6s %9s %10s %10s %10s %10s %9s\n", "h/R", "dofs", "press", "mean [N]", "ripple RMS", "range",
              "max jump", "lateral", "set-up");
  bool good = true;
  for (double h_over_r : {0.94, 0.63, 0.47, 0.33, 0.23}) {
    const Ripple r = slide(h_over_r * sphere_radius);
    const bool counts = h_over_r <= 1.0 / 3.0, smooth = r.rms <= allowed_ripple && r.clean;
    std::printf("  %-5.2f %7lld %6.1f %9.5f %8.2f %% %8.2f %% %8.3f %% %8.2f %% %7.1f s  %s", h_over_r,
                static_cast<long long>(r.dofs), r.pressing, r.mean, 100.0 * r.rms, 100.0 * r.range, 100.0 * r.jump,
                100.0 * r.lateral, r.seconds,
                !counts  ? ""
                : smooth ? "pass"
                         : "FAIL");
    std::printf("%s%s\n", r.clean ? "" : " (status not clean)", r.dropped ? "  (points dropped)" : "");
    std::fflush(stdout);
    good = good && (smooth || !counts);
  }
  std::printf("  allowed: a ripple of %.0f %% RMS where h <= R/3\n", 100.0 * allowed_ripple);
  return good;
}

}  // namespace indentation
