// Bullet's deformable bodies on the standard block, as a baseline.
#include "implicit.hpp"

#ifdef PALPATE_BENCH_BULLET
#include "../common/bullet_body.hpp"
#endif

namespace implicit_path {

#ifdef PALPATE_BENCH_BULLET
namespace {

// The block under its weight: implicit Euler, co-rotated linear elasticity without damping.
constexpr double h = 1e-3, together = 0.2;  // [s]

}  // namespace

void measure_bullet(bench::RowFile& rows, int n) {
  const Pressing pressing(n);
  Scene scene;
  scene.fix(pressing.block.constrained).gravity(Vector3(0.0, 0.0, -9.81));
  detail::CorotatedMotionOptions options;
  options.solve.tolerance = 3e-3;
  detail::CorotatedMotion<float> ours(pressing.body, scene, options);
  const Mesh<Tet4>& mesh = pressing.body.rest.mesh;
  bench::BulletBody theirs(mesh, lumped_mass(pressing.body.rest), pressing.block.constrained,
                           std::make_unique<btDeformableLinearElasticityForce>(
                               static_cast<btScalar>(bench::tissue.shear_modulus()),
                               static_cast<btScalar>(bench::tissue.lame_lambda()), btScalar(0), btScalar(0)),
                           9.81);
  std::vector<double> own, other;
  const NodeId top = pressing.block.touched.front();
  double apart = 0.0, deepest = 0.0;
  const double rest = mesh.position(top).z();
  for (int k = 0; k * h < together; ++k) {
    own.push_back(bench::seconds_of([&] { ours.step(h); }));
    other.push_back(bench::seconds_of([&] { theirs.step(h); }));
    const double sunk = ours.displacement()[3 * Index{top} + 2];
    deepest = std::max(deepest, std::abs(sunk));
    apart = std::max(apart, std::abs(theirs.position(top).z() - rest - sunk));
  }
  const double us = bench::percentile(own, 0.5), them = bench::percentile(other, 0.5);
  char text[80];
  std::snprintf(text, sizeof text, ", largest difference %.0f %% in %.1f s", 100.0 * apart / deepest, together);
  rows.add({.target = "n",
            .what = "step of 1 ms of a block under its weight against Bullet, " + std::to_string(mesh.element_count()) +
                    " tets",
            .figure = bench::milliseconds(us),
            .baseline = bench::milliseconds(them) + text,
            .ratio = them / us,
            .bound = {},
            .error = apart <= 0.25 * deepest ? "" : "the two motions differ"});
}

#else

void measure_bullet(bench::RowFile& rows, int n) {
  rows.skip("n", "step of 1 ms against Bullet, " + std::to_string(6 * n * n * n) + " tets",
            "Bullet is not installed (libbullet-dev)");
}

#endif

}  // namespace implicit_path
