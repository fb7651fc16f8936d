// Changes of loads, gravity and pose, and reset: same results as a new model, no new factorisation, strong guarantee.
#include "model/any_model.hpp"
#include "model/reference.hpp"

using namespace test;

namespace {

/// A model that counts the progress calls of its set-up.
struct Counted {
  int calls = 0;
  std::unique_ptr<AnyModel> model;
  Counted(PolicyName policy, const Scene& scene) {
    SetupOptions options;
    options.progress = [this](const Progress&) { return ++calls > 0; };
    model = make_model(policy, brick(), scene, liver, options);
    calls = 0;
  }
  AnyModel* operator->() { return model.get(); }
};

Eigen::Isometry3d some_pose() {
  testing::Random random(37);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  pose.linear() = testing::random_rotation(random);
  pose.translation() = Vector3(0.3, -0.2, 5.0);
  return pose;
}

/// Positions of the surface in the world frame.
std::vector<Vector3> world_surface(const AnyModel& model) {
  std::vector<Vector3> x;
  for (const Vector3& p : model.contact_surface().positions()) x.push_back(model.to_world() * p);
  return x;
}

void check_surface(const AnyModel& model, const Eigen::Isometry3d& pose) {
  const auto x = world_surface(model);
  const auto& nodes = model.touchable_nodes();
  REQUIRE(x.size() == nodes.size());
  for (std::size_t v = 0; v < x.size(); ++v) {
    const Vector3 moved = model.rest_position(nodes[v]) + model.displacement().segment<3>(3 * Index{nodes[v]});
    CHECK(largest(x[v] - pose * moved) <= 1e-14 * (1.0 + largest(x[v])));
  }
}

/// The state that must not change when a call fails.
struct State {
  VectorX u, r, f;
  double energy;
  std::vector<Vector3> surface;
  Matrix3 c;
  explicit State(AnyModel& m)
      : u(m.displacement()),
        r(m.reactions()),
        f(m.internal_force()),
        energy(m.strain_energy()),
        surface(world_surface(m)) {
    const int v = 7;
    m.require_columns({&v, 1});
    c = m.compliance(3, 7);
  }
  bool operator==(const State&) const = default;
};

}  // namespace

TEST_CASE("changed loads give the results of a new model, without set-up", "[model][changes]") {
  const Scene plain = brick_scene().prescribe(std::vector<NodeId>{3}, {0.0, std::nullopt, std::nullopt});
  const Scene full_scene = loaded(brick_scene());
  const Reference truth(brick(), {liver}, full_scene);
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    Counted model(policy, full_scene);
    model->set_conditions(plain);
    CHECK(model->displacement().isZero(0.0));
    model->set_conditions(full_scene);
    CHECK(relative(model->displacement(), truth.displacement) <= accuracy(policy));
    const auto fresh = make_model(policy, brick(), full_scene, liver);
    CHECK(model->displacement() == fresh->displacement());
    CHECK(model->reactions() == fresh->reactions());
    CHECK(model->strain_energy() == fresh->strain_energy());
    check_surface(*model.model, Eigen::Isometry3d::Identity());
    CHECK(model.calls == 0);
  }
}

TEST_CASE("changed prescribed values", "[model][changes]") {
  const auto scene = [](double pull) { return brick_scene().prescribe("x1", {pull, 0.5 * pull, std::nullopt}); };
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    Counted model(policy, scene(0.0));
    CHECK(model->displacement().isZero(0.0));
    for (double pull : {1e-3, -2e-3}) {
      model->set_conditions(scene(pull));
      CHECK(relative(model->displacement(), Reference(brick(), {liver}, scene(pull)).displacement) <= accuracy(policy));
    }
    CHECK(model.calls == 0);
  }
}

TEST_CASE("changed gravity", "[model][changes]") {
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    Counted model(policy, brick_scene().traction("x1", {5.0, 2.0, -10.0}));
    for (const Vector3& g : {Vector3(0, 0, -9.81), Vector3(3, 4, 5), Vector3(0, 0, 0)}) {
      model->set_gravity(g);
      const auto fresh = make_model(policy, brick(), brick_scene().traction("x1", {5.0, 2.0, -10.0}).gravity(g), liver);
      CHECK(model->displacement() == fresh->displacement());
      check_surface(*model.model, Eigen::Isometry3d::Identity());
    }
    CHECK(model.calls == 0);
  }
}

TEST_CASE("gravity acts on a rotated organ in the world direction", "[model][changes][M2]") {
  const Eigen::Isometry3d pose = some_pose();
  const Vector3 g(0, 0, -9.81);
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    Counted model(policy, brick_scene().gravity(g));
    model->set_pose(pose);
    Reference truth(brick(), {liver}, brick_scene());
    truth.set_scene(brick_scene(), pose.linear().transpose() * g);
    CHECK(relative(model->displacement(), truth.displacement) <= accuracy(policy));
    check_surface(*model.model, pose);
    model->set_gravity({0, 5, 0});  // in the world, not in the body
    truth.set_scene(brick_scene(), pose.linear().transpose() * Vector3(0, 5, 0));
    CHECK(relative(model->displacement(), truth.displacement) <= accuracy(policy));
    model->set_conditions(brick_scene().gravity(g));
    truth.set_scene(brick_scene(), pose.linear().transpose() * g);
    CHECK(relative(model->displacement(), truth.displacement) <= accuracy(policy));
    check_surface(*model.model, pose);
    CHECK(model.calls == 0);
  }
}

TEST_CASE("a moved organ without gravity does not deform", "[model][changes]") {
  const auto model =
      make_model(PolicyName::condensed_inverse, brick(), brick_scene().traction("x1", {5, 2, -10}), liver);
  const VectorX before = model->displacement();
  model->set_pose(some_pose());
  CHECK(model->displacement() == before);
  check_surface(*model, some_pose());
}

TEST_CASE("setting the current pose changes nothing", "[model][changes]") {
  const auto model = make_model(PolicyName::condensed_inverse, brick(), brick_scene(), liver);
  CHECK(model->pose().isApprox(Eigen::Isometry3d::Identity(), 0.0));
  const auto before = world_surface(*model);
  model->set_pose(model->pose());
  CHECK(world_surface(*model) == before);
  model->set_pose(some_pose());
  const auto moved = world_surface(*model);
  model->set_pose(model->pose());
  CHECK(world_surface(*model) == moved);
}

TEST_CASE("reset restores the initial state", "[model][changes]") {
  for (PolicyName policy :
       {PolicyName::sparse_cholesky, PolicyName::conjugate_gradient, PolicyName::condensed_inverse}) {
    INFO(name(policy));
    Counted model(policy, loaded(brick_scene()));
    const State before(*model.model);
    model->set_pose(some_pose());
    model->set_gravity({0, 0, 20});
    model->set_conditions(
        brick_scene().prescribe(std::vector<NodeId>{3}, {2e-3, std::nullopt, std::nullopt}).traction("x1", {1, 1, 1}));
    CHECK_FALSE(State(*model.model) == before);
    model->reset();
    CHECK(State(*model.model) == before);
    CHECK(model.calls == 0);
  }
}

TEST_CASE("the compliance does not depend on the loads", "[model][changes]") {
  const auto model = make_model(PolicyName::sparse_cholesky, brick(), brick_scene(), liver);
  const auto vertices = all_vertices(12);
  model->require_columns(vertices);
  const Matrix3 before = model->compliance(2, 9);
  model->set_conditions(brick_scene().traction("z1", {50, 0, 0}));
  model->require_columns(vertices);
  CHECK(model->compliance(2, 9) == before);
}

TEST_CASE("a refused change changes nothing", "[model][changes][strong]") {
  const Scene scene = loaded(brick_scene());
  for (PolicyName policy :
       {PolicyName::sparse_cholesky, PolicyName::conjugate_gradient, PolicyName::condensed_inverse}) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), scene, liver);
    const State before(*model);
    const auto refused = [&](SetupErrorKind kind, const std::function<void()>& change) {
      CHECK(to_string(refusal(change).kind) == to_string(kind));
      CHECK(State(*model) == before);
    };
    refused(SetupErrorKind::unknown_group, [&] { model->set_conditions(Scene(scene).traction("nowhere", {1, 0, 0})); });
    refused(SetupErrorKind::unknown_group,
            [&] { model->set_conditions(Scene(scene).initial_strain("nowhere", Vector6::Ones())); });
    refused(SetupErrorKind::conflicting_conditions, [&] {
      model->set_conditions(Scene(scene).prescribe("x0", {1.0, 0.0, 0.0}));
    });
    refused(SetupErrorKind::unsupported, [&] { model->set_conditions(brick_scene()); });  // node 3 would become free
    refused(SetupErrorKind::unsupported, [&] { model->set_conditions(Scene(scene).fix("z1")); });
    refused(SetupErrorKind::index_out_of_range, [&] {
      model->set_conditions(Scene(scene).point_load(std::vector<NodeId>{99}, {1, 0, 0}));
    });
    refused(SetupErrorKind::non_finite, [&] { model->set_gravity({0, 0, std::numeric_limits<double>::quiet_NaN()}); });
    refused(SetupErrorKind::bad_argument,
            [&] { model->set_pose(Eigen::Isometry3d(Eigen::Matrix4d(2.0 * Eigen::Matrix4d::Identity()))); });
    Eigen::Isometry3d mirror = Eigen::Isometry3d::Identity();
    mirror.linear()(0, 0) = -1.0;
    refused(SetupErrorKind::bad_argument, [&] { model->set_pose(mirror); });
  }
}

TEST_CASE("a change whose result overflows changes nothing", "[model][changes][strong]") {
  const LinearElastic mist{1e-6, 0.3, 1e3};  // so soft that a large load has no finite displacement
  const Scene scene = loaded(brick_scene());
  for (PolicyName policy :
       {PolicyName::sparse_cholesky, PolicyName::conjugate_gradient, PolicyName::condensed_inverse}) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), scene, mist);
    const State before(*model);
    CHECK_THROWS_AS(model->set_gravity({0.0, 0.0, 1e308}), SetupError);
    CHECK(State(*model) == before);
    CHECK_THROWS_AS(model->set_conditions(Scene(scene).traction("x1", {1e308, 0.0, 0.0})), SetupError);
    CHECK(State(*model) == before);
    const Vector3 g(0.0, 0.0, -9.81);  // and the next change works
    CHECK_NOTHROW(model->set_gravity(g));
    CHECK((model->displacement() == make_model(policy, brick(), Scene(scene).gravity(g), mist)->displacement()));
  }
}

TEST_CASE("gravity needs a density", "[model][changes][strong]") {
  const LinearElastic light{5e3, 0.45, 0.0};
  CHECK_REFUSED(SetupErrorKind::bad_density,
                make_model(PolicyName::sparse_cholesky, brick(), brick_scene().gravity({0, 0, -9.81}), light));
  const auto model = make_model(PolicyName::sparse_cholesky, brick(), brick_scene().traction("x1", {1, 0, 0}), light);
  const State before(*model);
  CHECK_REFUSED(SetupErrorKind::bad_density, model->set_gravity({0, 0, -9.81}));
  CHECK_REFUSED(SetupErrorKind::bad_density, model->set_conditions(brick_scene().gravity({0, 0, -9.81})));
  CHECK(State(*model) == before);
  CHECK_NOTHROW(model->set_gravity({0, 0, 0}));
}

TEST_CASE("new loads may name any group of the mesh", "[model][changes]") {
  // The scene of construction does not name y1.
  const auto model = make_model(PolicyName::sparse_cholesky, brick(), brick_scene(), liver);
  const Scene pressed = brick_scene().pressure("y1", 20.0);
  REQUIRE_NOTHROW(model->set_conditions(pressed));
  CHECK(relative(model->displacement(), Reference(brick(), {liver}, pressed).displacement) <= 1e-11);
}

TEST_CASE("a scene with another touchable set is refused", "[model][changes][strong]") {
  const Scene scene = loaded(brick_scene());
  for (PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::condensed_inverse}) {
    INFO(name(policy));
    const auto model = make_model(policy, brick(), scene, liver);
    const State before(*model);
    const auto refused = [&](const Scene& other) {
      const SetupProblem p = refusal([&] { model->set_conditions(other); });
      CHECK(to_string(p.kind) == "unsupported");
      CHECK_THAT(p.hint, contains("make a new model"));
      CHECK(State(*model) == before);
    };
    refused(Scene(scene).traction("x1", {1, 0, 0}).touch("y1"));  // more
    refused(loaded(Scene().fix("x0").touch("y1")));               // others
    refused(loaded(Scene().fix("x0").touch("surface")));
    CHECK_REFUSED(SetupErrorKind::unknown_group, model->set_conditions(Scene(scene).touch("liver")));
    CHECK(State(*model) == before);
  }
}

TEST_CASE("a model without touch refuses a scene with one", "[model][changes][strong]") {
  const Scene scene = Scene().fix("x0").traction("x1", {5, 0, 0});
  const auto model = make_model(PolicyName::sparse_cholesky, brick(), scene, liver);
  CHECK_REFUSED(SetupErrorKind::unsupported, model->set_conditions(Scene(scene).touch("z1")));
  CHECK_NOTHROW(model->set_conditions(scene));
}

TEST_CASE("the same touchable set may be specified differently, or omitted", "[model][changes]") {
  const Mesh<Tet4> mesh = brick();
  const Scene untouched = loaded(Scene().fix("x0"));
  const auto model = make_model(PolicyName::sparse_cholesky, mesh, loaded(brick_scene().touch("x1")), liver);
  const VectorX u = model->displacement();
  const auto same = [&](const Scene& scene) {
    model->set_conditions(
        brick_scene().touch("x1").prescribe(std::vector<NodeId>{3}, {0.0, std::nullopt, std::nullopt}));
    CHECK_FALSE(model->displacement() == u);
    REQUIRE_NOTHROW(model->set_conditions(scene));
    CHECK(model->displacement() == u);
  };
  same(untouched);
  same(Scene(untouched).touch("x1").touch("z1"));
  same(Scene(untouched).touch("z1").touch("x1").touch("z1"));
  const Group& top = *mesh.groups.find("z1");
  same(Scene(untouched).touch("x1").touch(std::vector<NodeId>(top.nodes.rbegin(), top.nodes.rend())));
}
