// Soft parts beside stiff ones: every part comes to equilibrium, whatever the forces in the others.
#include <palpate/element/wrappers.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/model/moving/equilibrium.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include "catch.hpp"

#include <utility>

using namespace palpate;

namespace {

const Vector3 bar_size(0.08, 0.02, 0.02);

/// A bar with a soft region, and a hard one where is_hard(centre).
template <class IsHard>
Mesh<Tet4> bar(IsHard&& is_hard) {
  Mesh<Tet4> mesh = box_tet4(bar_size, {16, 4, 4}, BoxSplit::six);
  mesh.region_names = {"soft", "hard"};
  for (const auto& element : mesh.elements) {
    Vector3 centre = Vector3::Zero();
    for (const NodeId node : element) centre += 0.25 * mesh.position(node);
    mesh.regions.push_back(is_hard(centre) ? 1 : 0);
  }
  return mesh;
}
Mesh<Tet4> hard_free_half() {
  return bar([](const Vector3& x) { return x[0] > 0.04; });
}
Scene hanging(double gravity) {
  return Scene().fix("x0").touch("z1").gravity({0.0, 0.0, -gravity});
}
std::vector<NeoHookean> laws(double ratio) {
  return {{5e3, 0.45, 1000.0}, {5e3 * ratio, 0.45, 1000.0}};
}
template <class S, Element E>
std::unique_ptr<TissueMotion> motion_of(const Mesh<E>& mesh, const Scene& scene, double ratio,
                                        const QuasiNewtonParameters& p) {
  return SolverTraits<Implicit<QuasiNewton<S>>>::make_motion(make_hyperelastic_body(mesh, laws(ratio)), scene, p, {})
      .motion;
}

}  // namespace

TEST_CASE("a stiff part that hangs on a soft one sags in single precision as in double", "[model][quasi_newton]") {
  const auto mesh = copy_mesh<Smoothed<Tet4>>(hard_free_half());
  for (const double ratio : {1.0, 1e2, 1e3, 1e4}) {
    INFO("ratio " << ratio);
    const auto single = motion_of<float>(mesh, hanging(0.4), ratio, {.inertia = false});
    const auto exact = motion_of<double>(mesh, hanging(0.4), ratio, {.inertia = false});
    CHECK(exact->displacement().cwiseAbs().maxCoeff() > 0.01);
    CHECK((single->displacement() - exact->displacement()).norm() <= 5e-3 * exact->displacement().norm());
    for (int k = 0; k < 20; ++k) CHECK(single->step(0.016).status.ok());
    CHECK((single->displacement() - exact->displacement()).norm() <= 5e-3 * exact->displacement().norm());
  }
}

TEST_CASE("a contrast that single precision cannot resolve is refused, with the remedy", "[model][quasi_newton]") {
  const auto mesh = copy_mesh<Smoothed<Tet4>>(hard_free_half());
  for (const bool settle : {true, false}) {
    const QuasiNewtonParameters p{.settle = settle, .inertia = false};
    try {
      motion_of<float>(mesh, hanging(0.04), 1e6, p);
      FAIL("not refused");
    } catch (const SetupError& e) {
      CHECK(e.kind() == SetupErrorKind::unsupported);
      CHECK(std::string(e.what()).find("QuasiNewton<double>") != std::string::npos);
    }
    CHECK_NOTHROW(motion_of<double>(mesh, hanging(0.04), 1e6, p));
  }
}

TEST_CASE("a stiff part under tension does not hide that a soft one is out of equilibrium", "[model][quasi_newton]") {
  const auto mesh = copy_mesh<Smoothed<Tet4>>(bar([](const Vector3& x) { return x[2] < 0.005; }));
  const Scene scene = Scene().fix("x0").fix("x1").touch("z1");
  VectorX stretched = VectorX::Zero(3 * mesh.node_count()), load = stretched;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    if (mesh.position(i)[0] > 0.0799) stretched[3 * i] = 0.01 * bar_size[0];
    if ((mesh.position(i) - Vector3(0.04, 0.01, 0.02)).norm() < 1e-6) load[3 * i + 2] = -0.01;
  }
  REQUIRE(load.sum() < 0.0);
  const auto pressed = [&](const QuasiNewtonParameters& p) {
    const auto motion = motion_of<double>(mesh, scene, 1e5, p);
    motion->set_prescribed(stretched);
    for (int k = 0; k < 20; ++k) motion->step(p.step);
    const double before = motion->displacement().dot(load);
    motion->set_load(load);
    for (int k = 0; k < 20; ++k) CHECK(motion->step(p.step).status.ok());
    return motion->displacement().dot(load) - before;
  };
  const double exact = pressed({.inertia = false, .maximum_iterations = 500, .tolerance = 1e-9});
  CHECK(exact > 0.01 * 1e-4);
  CHECK(std::abs(pressed({.inertia = false}) - exact) <= 0.02 * exact);
}

TEST_CASE("Newton steps too flag a soft part out of equilibrium beside a stiff one", "[model][dynamics]") {
  const auto mesh = bar([](const Vector3& x) { return x[2] < 0.005; });
  const Scene scene = Scene().fix("x0").fix("x1").touch("z1");
  VectorX stretched = VectorX::Zero(3 * mesh.node_count()), load = stretched;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    if (mesh.position(i)[0] > 0.0799) stretched[3 * i] = 0.01 * bar_size[0];
    if (mesh.position(i)[2] > 0.0199) load[3 * i + 1] = 0.04;
  }
  const auto sheared = [&](int most_iterations) {
    const auto motion =
        SolverTraits<Implicit<Newton>>::make_motion(
            make_hyperelastic_body(mesh, laws(1e5)), scene,
            {.settle = false, .newton = {.maximum_iterations = most_iterations, .tolerance = 1e-12}}, {})
            .motion;
    motion->set_prescribed(stretched);
    for (int k = 0; k < 20; ++k) motion->step(1e3);
    motion->set_load(load);
    const Status status = motion->step(1e3).status;
    return std::pair{motion->displacement().dot(load), status};
  };
  const auto [exact, converged] = sheared(100);
  const auto [early, flagged] = sheared(1);
  CHECK(converged.ok());
  CHECK(std::abs(early - exact) > 0.1 * exact);
  CHECK(flagged.has(StatusFlag::solver_not_converged));
}

TEST_CASE("a bar with a stiff free half settles under large loads, as by Newton's method", "[model][quasi_newton]") {
  const Mesh<Tet4> mesh = hard_free_half();
  const double ratio = GENERATE(1e3, 1e4, 1e5), gravity = GENERATE(3.5, 4.0, 4.5);  // rounding differs
  INFO("ratio " << ratio << ", gravity " << gravity);
  Equilibrium newton(make_constrained_body(make_hyperelastic_body(mesh, laws(ratio)), hanging(gravity)));
  REQUIRE(newton.solve().converged);
  CHECK(newton.displacement().cwiseAbs().maxCoeff() > 0.03);
  const auto motion = motion_of<double>(mesh, hanging(gravity), ratio, {.inertia = false});
  CHECK((motion->displacement() - newton.displacement()).norm() <= 1e-4 * newton.displacement().norm());
}
