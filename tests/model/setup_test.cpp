// Set-up: errors, report and options.
#include <palpate/linear/condition.hpp>
#include <palpate/mesh/mesh_arrays.hpp>
#include <map>
#include <sstream>

#include "mesh/two_cubes.hpp"
#include "model/any_model.hpp"
#include "model/reference.hpp"
#include "refused.hpp"

using namespace test;

namespace {

std::unique_ptr<AnyModel> model_of(const Mesh<Tet4>& mesh, const Scene& scene, const LinearElastic& m = liver,
                                   const SetupOptions& options = {}) {
  return make_model(PolicyName::condensed_inverse, mesh, scene, m, options);
}

/// Starts two threads and counts the calls.
struct CountingPool {
  int* calls;
  int threads() const noexcept { return 2; }
  void run(int count, const ExecutorTask& task) const {
    ++*calls;
    detail::StartedThreads(2).run(count, task);
  }
};

}  // namespace

TEST_CASE("a set-up uses the given threads, and its results do not depend on them", "[model][threads]") {
  const Mesh<Tet4> mesh = box_tet4(Vector3(0.1, 0.1, 0.1), {17, 17, 17});
  std::vector<NodeId> patch;
  for (NodeId i = 0; i < mesh.node_count(); ++i)
    if (const Vector3 p = mesh.position(i); p.z() > 0.099 && (p.head<2>() - Vector2(0.05, 0.05)).norm() < 0.01)
      patch.push_back(i);
  const Scene scene = Scene().fix("z0").touch(patch);
  int calls = 0;
  CountingPool pool{&calls};
  VectorX first, x;
  double condition = 0.0, probe_error = 0.0;
  const std::vector<VertexForce> press{{0, ModelVector(Vector3(0.1, 0.0, -0.2))}};
  for (const SetupThreads& threads : {SetupThreads(1), SetupThreads(3), SetupThreads(pool)}) {
    SetupOptions options;
    options.threads = threads;
    const auto model = model_of(mesh, scene, liver, options);
    model->displacement_with(press, x);
    const SetupReport& report = model->report();
    if (first.size() == 0) first = x, condition = report.condition_estimate, probe_error = report.probe_error;
    CHECK(x == first);
    CHECK(report.condition_estimate == condition);
    CHECK(report.probe_error == probe_error);
  }
  CHECK(calls >= 10);  // elimination order, factorisation, and two sweeps of every solve
}

TEST_CASE("the report counts and measures", "[model][report]") {
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), brick_scene(), LinearElastic{5e3, 0.3, 1000.0});
    const SetupReport& r = model->report();
    CHECK(r.nodes == 36);
    CHECK(r.elements == 60);
    CHECK(r.free_dofs == 81);
    CHECK(r.kept_dofs == 27);  // twelve touchable nodes, three of them constrained
    CHECK(r.condensed_dofs == 54);
    CHECK(r.touchable_vertices == 12);
    CHECK(r.rendered_nodes == 34);  // two nodes are inside
    CHECK(r.stiffness_bytes > 0);
    CHECK(r.solver_bytes > 0);
    CHECK(r.compliance_bytes == (policy == PolicyName::condensed_float ? 4u : 8u) * 36 * 36);
    CHECK(r.worst_quality > 0.1);
    CHECK(r.worst_quality <= r.mean_quality);
    CHECK(r.mean_quality <= 1.0);
    CHECK(r.probe_error <= accuracy(policy));
    CHECK(r.total_seconds() > 0.0);
    if (policy != PolicyName::condensed_float) CHECK(r.flags == 0);
    CHECK(r.remarks.size() == static_cast<std::size_t>(std::popcount(r.flags)));
    std::ostringstream text;
    text << r;
    CHECK_THAT(text.str(), contains("81 free dofs"));
  }
}

TEST_CASE("only loads that deform the body too much for small strain are flagged", "[model][report]") {
  const Mesh<Tet4> mesh = brick();
  const auto model = model_of(mesh, Scene().fix("z0").touch("z1").gravity({1.0, 0.0, 0.0}), {5e3, 0.3, 1000.0});
  const auto flagged = [&] { return model->report().has(SetupFlag::large_displacement); };
  const VectorX u = model->displacement();
  const Eigen::Map<const Eigen::Matrix3Xd> moved(u.data(), 3, u.size() / 3);
  const double spread = (moved.colwise() - moved.rowwise().mean()).colwise().norm().maxCoeff();
  Vector3 low = mesh.positions[0], high = low;
  for (const Vector3& x : mesh.positions) {
    low = low.cwiseMin(x);
    high = high.cwiseMax(x);
  }
  const double just = 0.1 * (high - low).norm() / spread;  // gravity that displaces it by a tenth of its size [m/s^2]
  CHECK_FALSE(flagged());
  model->set_gravity({1.01 * just, 0.0, 0.0});
  CHECK(flagged());
  model->set_gravity({0.99 * just, 0.0, 0.0});
  CHECK_FALSE(flagged());
  model->set_gravity({-2.0 * just, 0.0, 0.0});
  CHECK(flagged());
  CHECK(model->report().remarks.size() == static_cast<std::size_t>(std::popcount(model->report().flags)));
  model->reset();
  CHECK_FALSE(flagged());
  const double far = 10.0 * (high - low).norm();  // a rigid motion is not flagged
  CHECK_FALSE(model_of(mesh, Scene().prescribe("z0", {far, 0.0, 0.0}).touch("z1"), {5e3, 0.3, 0.0})
                  ->report()
                  .has(SetupFlag::large_displacement));
}

TEST_CASE("the condition estimate is within a factor of ten", "[model][report]") {
  const LinearElastic m{5e3, 0.3, 1000.0};
  const Mesh<Tet4> mesh = brick();
  const EssentialConditions c = conditions_of(mesh, brick_scene());
  const MatrixX lower = MatrixX(free_matrix(assemble_stiffness<Tet4>(body_of(mesh, {m}), {}), c));
  const MatrixX k = lower.selfadjointView<Eigen::Lower>();
  const MatrixX inverse = Eigen::LLT<MatrixX>(k).solve(MatrixX::Identity(k.rows(), k.rows()));
  const double exact = k.cwiseAbs().colwise().sum().maxCoeff() * inverse.cwiseAbs().colwise().sum().maxCoeff();
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const double estimate = make_model(policy, mesh, brick_scene(), m)->report().condition_estimate;
    CHECK(estimate >= 0.1 * exact);
    CHECK(estimate <= 1.001 * exact);
  }
}

TEST_CASE("flags", "[model][report]") {
  SECTION("locking above a Poisson ratio of 0.4") {
    CHECK_FALSE(model_of(brick(), brick_scene(), {5e3, 0.4, 0.0})->report().has(SetupFlag::locking));
    CHECK(model_of(brick(), brick_scene(), {5e3, 0.401, 0.0})->report().has(SetupFlag::locking));
  }
  SECTION("one region is enough") {
    const Scene scene = Scene().fix("fixed").touch("end");
    const Materials two{{"cube_a", {1e3, 0.3, 0.0}}, {"cube_b", {1e3, 0.45, 0.0}}};
    const auto model = make_model(PolicyName::sparse_cholesky, two_cubes(), scene, two);
    CHECK(model->report().has(SetupFlag::locking));
    std::ostringstream text;
    text << model->report();
    CHECK_THAT(text.str(), contains("Poisson ratio of 0.45"));
  }
  SECTION("millimetres") {
    Mesh<Tet4> mesh = brick();
    for (Vector3& x : mesh.positions) x *= 1000.0;
    CHECK(model_of(mesh, brick_scene())->report().has(SetupFlag::suspicious_units));
  }
  SECTION("values that look like other units: in the report, and refused on request") {
    SetupOptions refusing;
    refusing.admission.units = Admission::refuse;
    const Scene heavy = brick_scene().gravity({0.0, 0.0, -9.81});
    struct Case {
      LinearElastic material;
      Scene scene;
      double value;
      const char* remark;
    };
    const Case cases[]{
        {{5.0, 0.4, 1000.0}, brick_scene(), 5.0, "has a Young's modulus of 5 Pa"},
        {{5e9, 0.4, 1000.0}, brick_scene(), 5e9, "has a Young's modulus of 5e+09 Pa"},
        {{5e3, 0.4, 1.06}, heavy, 1.06, "has a density of 1.06 kg/m^3"},
        {{5e3, 0.4, 1.06e6}, heavy, 1.06e6, "has a density of 1060000 kg/m^3"},
        {{5e3, 0.4, 1060.0}, brick_scene().gravity({0.0, 0.0, -9810.0}), 9810.0, "gravity is 9810 m/s^2"},
        {{5e3, 0.4, 1060.0}, Scene().fix("z0").touch("z1", {.radius = 4.0}), 4.0, "the tool has a radius of 4 m"},
    };
    for (const Case& c : cases) {
      INFO(c.remark);
      const auto model = model_of(brick(), c.scene, c.material);
      CHECK(model->report().has(SetupFlag::suspicious_units));
      std::ostringstream text;
      text << model->report();
      CHECK_THAT(text.str(), contains(c.remark));
      const SetupProblem problem = refusal([&] { model_of(brick(), c.scene, c.material, refusing); });
      CHECK(problem.kind == SetupErrorKind::suspicious_units);
      CHECK(std::abs(problem.value - c.value) <= 1e-9 * c.value);
      CHECK_THAT(problem.what, contains(c.remark));
    }
    const auto both = model_of(brick(), heavy, {5.0, 0.4, 1.06});
    CHECK(both->report().remarks.size() == static_cast<std::size_t>(std::popcount(both->report().flags)));
    for (const double modulus : {200.0, 5e3, 5e7})
      for (const double density : {0.0, 250.0, 1060.0, 8000.0}) {
        const auto model = model_of(brick(), brick_scene(), {modulus, 0.4, density}, refusing);
        CHECK_FALSE(model->report().has(SetupFlag::suspicious_units));
      }
    // Bone beside tissue, or metal, is not suspicious.
    const Scene scene = Scene().fix("fixed").touch("end");
    const Materials two{{"cube_a", {1e3, 0.3, 0.0}}, {"cube_b", {2e11, 0.3, 7800.0}}};
    auto small = two_cubes();
    for (Vector3& x : small.positions) x *= 0.1;
    CHECK_FALSE(make_model(PolicyName::sparse_cholesky, small, scene, two, refusing)
                    ->report()
                    .has(SetupFlag::suspicious_units));
  }
  SECTION("a touchable part that is fixed") {
    CHECK(model_of(brick(), Scene().fix("z0").touch("z0"))->report().has(SetupFlag::fixed_contact));
    CHECK_FALSE(model_of(brick(), Scene().fix("z0").touch("surface"))->report().has(SetupFlag::fixed_contact));
    const Scene sliding = Scene().fix("z0").prescribe("z1", {std::nullopt, std::nullopt, 0.0}).touch("z1");
    CHECK_FALSE(model_of(brick(), sliding)->report().has(SetupFlag::fixed_contact));
  }
  SECTION("pieces") {
    Mesh<Tet4> mesh = brick();
    const Mesh<Tet4> one = mesh;
    for (const Vector3& x : one.positions) mesh.positions.push_back(x + Vector3(1, 0, 0));
    for (auto e : one.elements) {
      for (NodeId& i : e) i += 36;
      mesh.elements.push_back(e);
    }
    std::vector<NodeId> constrained;
    for (NodeId i = 0; i < 72; ++i)
      if (i % 4 == 0) constrained.push_back(i);
    CHECK(model_of(mesh, Scene().fix(constrained).touch("z1"))->report().has(SetupFlag::disconnected));
  }
  SECTION("slivers") {
    const Mesh<Tet4> mesh = box_tet4({0.0, 0.1, 0.1001}, {0.0, 0.05}, {0.0, 0.05});
    const auto model = model_of(mesh, brick_scene());
    CHECK(model->report().has(SetupFlag::poor_quality));
    CHECK(model->report().worst_quality < 0.1);
  }
}

TEST_CASE("a repaired mesh is flagged and mapped", "[model][report][extreme][B4][B6]") {
  const Scene scene = brick_scene().gravity({0, 0, -9.81});
  const auto good = model_of(brick(), scene);
  CHECK_FALSE(good->report().has(SetupFlag::repaired));
  SetupOptions repair_inverted;
  repair_inverted.admission.inverted = Admission::repair;
  SECTION("orphan nodes are dropped by default") {
    Mesh<Tet4> mesh = brick();
    mesh.positions.insert(mesh.positions.begin(), Vector3(0.05, 0.03, 0.02));
    for (auto& e : mesh.elements)
      for (NodeId& i : e) ++i;
    for (Group& g : mesh.groups.all()) {
      for (NodeId& i : g.nodes) ++i;
      for (auto& face : g.faces)
        for (NodeId& i : face) ++i;
    }
    const auto model = model_of(mesh, scene);
    CHECK(model->report().has(SetupFlag::repaired));
    CHECK(model->node_map().front() == -1);
    CHECK(model->node_map().back() == 35);
    CHECK(relative(model->displacement(), good->displacement()) <= 1e-13);
  }
  SECTION("an inverted element is repaired on request") {
    Mesh<Tet4> mesh = brick();
    std::swap(mesh.elements[7][0], mesh.elements[7][3]);
    CHECK_REFUSED(SetupErrorKind::inverted_element, model_of(mesh, scene));
    const auto model = model_of(mesh, scene, liver, repair_inverted);
    CHECK(model->report().has(SetupFlag::repaired));
    CHECK(relative(model->displacement(), good->displacement()) <= 1e-13);
  }
}

TEST_CASE("set-up can be cancelled at every stage and leaves nothing behind", "[model][progress]") {
  const Scene scene = loaded(brick_scene());
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    std::map<std::string, int, std::less<>> stages;
    int calls = 0, stop_at = -1;
    SetupOptions options;
    options.progress = [&](const Progress& p) {
      CHECK(p.fraction >= 0.0);
      CHECK(p.fraction <= 1.0);
      ++stages[std::string(p.stage)];
      return calls++ != stop_at;
    };
    make_model(policy, brick(), scene, liver, options);
    CHECK(stages.count("admission") == 1);
    CHECK(stages.count("assembly") == 1);
    CHECK(stages["checks"] > 2);  // before every solve
    const int all = calls;
    REQUIRE(all >= 3);
    for (stop_at = 0; stop_at < all; ++stop_at) {
      calls = 0;
      CHECK_REFUSED(SetupErrorKind::cancelled, make_model(policy, brick(), scene, liver, options));
      CHECK(calls == stop_at + 1);
    }
  }
}

TEST_CASE("a model that is too large is refused with the number of bytes", "[model][memory][extreme][B10]") {
  SetupOptions options;
  options.memory_limit = 2000;
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const SetupProblem p = refusal([&] { make_model(policy, brick(), brick_scene(), liver, options); });
    CHECK(to_string(p.kind) == "too_large");
    CHECK(p.threshold == 2000.0);
    CHECK(p.value > 2000.0);
    CHECK(p.value < 1e6);
  }
}

TEST_CASE("the limit applies to the stiffness and its factor as well", "[model][memory][extreme][B10]") {
  // Nothing is touched: no compliance, but tens of kilobytes of K and of L.
  SetupOptions options;
  options.memory_limit = 2000;
  for (PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::matrix_free_conjugate_gradient}) {
    INFO(name(policy));
    CHECK_REFUSED(SetupErrorKind::too_large, make_model(policy, brick(), Scene().fix("x0"), liver, options));
  }
}

TEST_CASE("the memory announced is the memory used", "[model][memory][extreme][B10]") {
  // With a limit just below what a condensed model reports, set-up is refused; with a generous one it is not.
  const auto model = model_of(brick(), brick_scene());
  SetupOptions options;
  options.memory_limit = model->report().compliance_bytes - 1;
  CHECK_REFUSED(SetupErrorKind::too_large, model_of(brick(), brick_scene(), liver, options));
  options.memory_limit = 100 * model->report().compliance_bytes;
  CHECK_NOTHROW(model_of(brick(), brick_scene(), liver, options));
}

TEST_CASE("materials by region", "[model][material]") {
  const Scene scene = Scene().fix("fixed").touch("end").point_load("load_point", {0, 0, -1});
  const LinearElastic soft{1e3, 0.3, 1.0}, hard{1e4, 0.2, 1.0};
  const auto answer = [&](const Materials& m) {
    return make_model(PolicyName::condensed_inverse, two_cubes(), scene, m)->displacement();
  };
  CHECK(relative(answer({{"cube_a", soft}, {"cube_b", hard}}),
                 Reference(two_cubes(), {soft, hard}, scene).displacement) <= 1e-11);
  CHECK(answer({{everywhere, soft}, {"cube_b", hard}}) == answer({{"cube_a", soft}, {"cube_b", hard}}));
  CHECK_REFUSED(SetupErrorKind::missing_material, answer({{"cube_a", soft}}));
  CHECK_REFUSED(SetupErrorKind::missing_material, answer({}));
  CHECK_REFUSED(SetupErrorKind::unknown_group, answer({{everywhere, soft}, {"cube_z", hard}}));
  CHECK_REFUSED(SetupErrorKind::bad_youngs_modulus, answer({{everywhere, soft}, {"cube_b", {0.0, 0.3, 1.0}}}));
}

TEST_CASE("scenes that do not fit the mesh are refused", "[model][scene]") {
  const auto with = [](Scene scene) { return model_of(brick(), scene); };
  CHECK_REFUSED(SetupErrorKind::unknown_group, with(brick_scene().fix("liver")));
  CHECK_REFUSED(SetupErrorKind::unknown_group, with(brick_scene().touch("liver")));
  CHECK_REFUSED(SetupErrorKind::unknown_group, with(brick_scene().render("liver")));
  CHECK_REFUSED(SetupErrorKind::index_out_of_range, with(brick_scene().touch(std::vector<NodeId>{36})));
  CHECK_REFUSED(SetupErrorKind::empty_group, with(brick_scene().touch(std::vector<NodeId>{5})));  // no face
  CHECK_REFUSED(SetupErrorKind::unconstrained, with(Scene().touch("z1")));
  CHECK_REFUSED(SetupErrorKind::conflicting_conditions, with(brick_scene().prescribe("x0", {1e-3, 0.0, 0.0})));
  CHECK_REFUSED(SetupErrorKind::empty_mesh, model_of({}, Scene()));
}

TEST_CASE("a model without a touchable surface still solves", "[model][scene]") {
  const Scene scene = Scene().fix("x0").traction("x1", {5, 0, 0});
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), scene, liver);
    CHECK(model->contact_surface().vertex_count() == 0);
    CHECK(relative(model->displacement(), Reference(brick(), {liver}, scene).displacement) <= accuracy(policy));
    CHECK(model->require_columns({}).ok());
  }
}

TEST_CASE("the origin of the model frame is the centre of the body", "[model][frame]") {
  Mesh<Tet4> mesh = brick();
  for (Vector3& x : mesh.positions) x += Vector3(100.0, -50.0, 7.0);
  const auto model = model_of(mesh, brick_scene().gravity({0, 0, -9.81}));
  for (NodeId i = 0; i < 36; ++i) {
    CHECK(largest(model->rest_position(i) - mesh.position(i)) <= 1e-13);
    CHECK(model->mesh().position(i).norm() <= 0.1);
  }
  const NodeId node = model->touchable_nodes().back();
  const Vector3 world = model->to_world() * model->contact_surface().positions().back();
  CHECK(largest(world - mesh.position(node) - model->displacement().segment<3>(3 * Index{node})) <= 1e-13);
}
