// Linear bodies in explicit motion: waves in a bar, and the modes of a cube.
#include <numbers>

#include "integrator/motions.hpp"
#include "number_rows.hpp"

#include <palpate/assembly/elastic_forces.hpp>

using namespace test;

namespace {

using std::numbers::pi;

template <class Scheme, Element E>
auto linear_motion(const Body<E>& body, const std::vector<Index>& free, const ExplicitOptions& options = {}) {
  return ExplicitMotion<LinearForces, Scheme>(LinearForces(assemble_stiffness<E>(body, {})), lumped_mass(body), free,
                                              element_frequency_bound(body), options);
}

/// Lame's mode of a cube of side 1: no change of volume, no traction on any face.
Vector3 lame_mode(const Vector3& p) {
  return {std::cos(pi * p.x()) * std::sin(pi * p.y()), -std::sin(pi * p.x()) * std::cos(pi * p.y()), 0.0};
}

/// Time of the n-th upward zero crossing, linearly interpolated between samples.
double crossing(const std::vector<double>& values, double dt, int n) {
  for (std::size_t i = 1; i < values.size(); ++i)
    if (values[i - 1] < 0.0 && values[i] >= 0.0 && n-- == 0)
      return dt * (static_cast<double>(i) - values[i] / (values[i] - values[i - 1]));
  return std::nan("");
}

}  // namespace

TEST_CASE("a wave in a bar with dt = dx / c equals d'Alembert's solution to rounding", "[integrator][oracle]") {
  const LinearElastic material{1e6, 0.0, 1000.0};
  const Body<Hex8> body = make_body(box_hex8(Vector3(1.0, 0.1, 0.1), {100, 1, 1}), material);
  const Mesh<Hex8>& mesh = body.mesh;
  const double dt = 0.01 / std::sqrt(1e6 / 1000.0);
  ExplicitOptions options;
  options.margin = 0.0;  // the step is the limit of a bar, 2e-5 below that of the block
  options.energy_growth = 4.0;
  auto motion =
      linear_motion<CentralDifference>(body, dofs_where(mesh, [](const Vector3& p) { return p.x() > 1e-9; }), options);
  Scene scene;
  scene.traction("x1", Vector3(1000.0, 0.0, 0.0));
  motion.load() = detail::applied_load(body, extract_boundary<Hex8>(mesh), scene);
  motion.require_step(dt);

  Index tip = -1;
  for (Index i = 0; i < mesh.node_count(); ++i)
    if (mesh.position(i).isApprox(Vector3(1.0, 0.1, 0.1))) tip = i;
  const auto rows = read_rows(PALPATE_TEST_DATA "/oracle/L_dynamic/bar_hex8/history_central_difference_lumped.csv", 1);
  double worst = 0.0;
  for (std::size_t step = 0; step < rows.size(); ++step) {
    if (step > 0) REQUIRE(motion.step(dt).ok());
    const double t = rows[step].at(0), exact = rows[step].at(1), reference = rows[step].at(2);
    const double u = motion.state().displacement[3 * tip];
    worst = std::max({worst, std::abs(u - reference), std::abs(u - exact)});
    CHECK(std::abs(motion.state().time - t) <= 1e-9);
  }
  CHECK(rows.size() == 401);
  CHECK(worst <= 1e-9 * 2e-3);
}

TEMPLATE_TEST_CASE("a free cube oscillates in its Lame mode", "[integrator]", Hex8, Tet10) {
  // omega L sqrt(rho/mu) = pi sqrt(2) for any nu; mu = 1, rho = 1
  const double nu = 0.3;
  const LinearElastic material{2.0 * (1.0 + nu), nu, 1.0};
  const auto frequency = [&](int n) {
    Mesh<TestType> mesh;
    if constexpr (TestType::nodes == 8)
      mesh = box_hex8(Vector3(1.0, 1.0, 1.0), {n, n, n});
    else
      mesh = box_tet10(Vector3(1.0, 1.0, 1.0), {n, n, n});
    const Body<TestType> body = make_body(std::move(mesh), material);
    auto motion = linear_motion<CentralDifference>(body, all_dofs(body.mesh));
    const VectorX mode = velocity_field(body.mesh, lame_mode);
    motion.set(-1e-3 * mode, VectorX::Zero(mode.size()));
    const VectorX weight = mode.cwiseProduct(motion.state().mass);
    const double dt = 0.3 * motion.limit();
    std::vector<double> history;
    while (motion.state().time < 2.8) {
      REQUIRE(motion.step(dt).ok());
      history.push_back(weight.dot(motion.state().displacement));
    }
    return 2.0 * pi / (crossing(history, dt, 1) - crossing(history, dt, 0));
  };
  const double exact = pi * std::sqrt(2.0);
  const double coarse = std::abs(frequency(4) / exact - 1.0), fine = std::abs(frequency(8) / exact - 1.0);
  INFO(coarse << ' ' << fine);
  CHECK(fine <= 0.012);
  CHECK(fine <= 0.4 * coarse);
}

TEST_CASE("explicit schemes have order of accuracy two and one", "[integrator]") {
  const Body<Tet4> body = make_body(box_tet4(Vector3(0.1, 0.1, 0.1), {2, 2, 2}), LinearElastic{3e3, 0.3, 1000.0});
  const std::vector<Index> free = above_ground(body.mesh);
  const auto end = [&]<class Scheme>(Scheme, int steps) {
    ExplicitOptions options;
    options.damping = 3.0;
    auto motion = linear_motion<Scheme>(body, free, options);
    motion.set(VectorX::Zero(3 * body.mesh.node_count()),
               velocity_field(body.mesh, [](const Vector3& p) -> Vector3 { return p.z() * Vector3(1.0, 0.5, -0.3); }));
    for (Index i = 0; i < body.mesh.node_count(); ++i) motion.load()[3 * i + 2] = -1e-3;
    for (int i = 0; i < steps; ++i) REQUIRE(motion.step(0.05 / steps).ok());
    return motion.state().displacement;
  };
  const auto order = [&](auto scheme) {
    const VectorX a = end(scheme, 200), b = end(scheme, 400), c = end(scheme, 800);
    return std::log2((a - b).norm() / (b - c).norm());
  };
  CHECK(std::abs(order(CentralDifference{}) - 2.0) <= 0.1);
  CHECK(std::abs(order(SemiImplicitEuler{}) - 1.0) <= 0.1);
}

TEST_CASE("prescribed motion: a bar stretched at constant speed", "[integrator]") {
  const Body<Hex8> body = make_body(box_hex8(Vector3(1.0, 0.1, 0.1), {20, 1, 1}), LinearElastic{1e6, 0.0, 1000.0});
  const Mesh<Hex8>& mesh = body.mesh;
  ExplicitOptions options;
  options.damping = 200.0;
  auto motion = linear_motion<CentralDifference>(
      body, dofs_where(mesh, [](const Vector3& p) { return p.x() > 1e-9 && p.x() < 1.0 - 1e-9; }), options);
  const double dt = 0.9 * motion.limit(), speed = 0.01;
  while (motion.state().time < 0.5) {
    for (Index i = 0; i < mesh.node_count(); ++i)
      if (mesh.position(i).x() > 0.5) motion.target()[3 * i] = speed * (motion.state().time + dt);
    REQUIRE(motion.step(dt).ok());
  }
  // slow enough to be static except for the damping force
  const double pulled = speed * motion.state().time;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const double x = mesh.position(i).x(), t = motion.state().displacement[3 * i];
    // steady state: sigma' = rho alpha speed x / L, u = pulled x + rho alpha speed (x^3 - x) / (6 E)
    const double exact = pulled * x + 1000.0 * 200.0 * speed * (x * x * x - x) / 6e6;
    CHECK(std::abs(t - exact) <= 1e-3 * pulled);
  }
  const double elastic = 0.5 * 1e6 * 0.01 * pulled * pulled;
  const double drag = 1000.0 * 0.01 * 200.0 * speed * speed / 3.0 * motion.state().time;
  CHECK(std::abs(motion.work() / (elastic + drag) - 1.0) <= 0.04);
  CHECK(motion.stored_energy() <= motion.work());
}
