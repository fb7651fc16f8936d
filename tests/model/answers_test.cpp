// Every policy gives the result of a dense solve in long double.
#include <palpate/testing/tissue_laws.hpp>

#include "model/any_model.hpp"
#include "model/reference.hpp"

using namespace test;

static_assert(TissueModel<AnyModel>);

namespace {

double worst_compliance_error(AnyModel& model, const Reference& reference) {
  const auto& nodes = model.touchable_nodes();
  double error = 0.0, scale = 0.0;
  for (std::size_t i = 0; i < nodes.size(); ++i)
    for (std::size_t j = 0; j < nodes.size(); ++j) {
      const Matrix3 truth = reference.compliance(nodes[i], nodes[j]);
      error = std::max(error, largest(model.compliance(static_cast<int>(i), static_cast<int>(j)) - truth));
      scale = std::max(scale, largest(truth));
    }
  return error / scale;
}

}  // namespace

TEST_CASE("all policies agree with the dense solve", "[model][policies]") {
  const Mesh<Tet4> mesh = brick();
  const Scene scene = loaded(brick_scene());
  const Reference truth(mesh, {liver}, scene);
  REQUIRE(truth.definite);
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const double bound = accuracy(policy);
    const auto model = make_model(policy, mesh, scene, liver);
    CHECK(model->mesh().node_count() == mesh.node_count());
    CHECK(relative(model->displacement(), truth.displacement) <= bound);

    const auto vertices = all_vertices(model->contact_surface().vertex_count());
    REQUIRE(vertices.size() == 12);
    REQUIRE(model->require_columns(vertices).ok());
    CHECK(worst_compliance_error(*model, truth) <= bound);
    CHECK(testing::describe(testing::tissue_laws(*model, vertices, {bound})) == "");
  }
}

TEST_CASE("forces of tools on top of the loads", "[model][policies]") {
  const Mesh<Tet4> mesh = brick();
  const Scene scene = loaded(brick_scene());
  Scene pushed = scene;
  const Reference rest(mesh, {liver}, scene);
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, mesh, scene, liver);
    const std::array forces{VertexForce{11, {0.02, 0.0, -0.1}}, VertexForce{5, {0.0, 0.03, -0.05}},
                            VertexForce{11, {0.01, 0.0, 0.0}},
                            VertexForce{0, {1.0, 1.0, 1.0}}};  // vertex 0 is constrained
    VectorX u(model->displacement().size()), expected = rest.displacement;
    const SolveReport report = model->displacement_with(forces, u);
    CHECK(report.converged);
    for (const VertexForce& f : forces)
      for (NodeId i = 0; i < static_cast<NodeId>(mesh.node_count()); ++i)
        expected.segment<3>(3 * i) +=
            rest.compliance(i, model->touchable_nodes()[static_cast<std::size_t>(f.vertex)]) * f.force.in_model_axes();
    CHECK(relative(u, expected) <= accuracy(policy));
    CHECK(relative(model->displacement(), rest.displacement) <= accuracy(policy));  // unchanged
    model->displacement_with({}, u);
    CHECK(u == model->displacement());
  }
}

TEST_CASE("thousands of simultaneous forces are all applied, or refused", "[model]") {
  const auto model = make_model(PolicyName::condensed_inverse, brick(), brick_scene(), liver);
  const std::vector<VertexForce> one{{11, {0.0, 0.0, -1.0}}};
  const std::vector<VertexForce> many(4000, {11, {0.0, 0.0, -1.0 / 4000}});
  VectorX u(model->displacement().size()), v = u;
  REQUIRE(model->displacement_with(one, u).converged);
  if (model->displacement_with(many, v).converged) CHECK(relative(v, u) <= 1e-9);
}

TEST_CASE("forces balance", "[model][policies]") {
  const Mesh<Tet4> mesh = brick();
  const Scene scene = loaded(brick_scene());
  const Reference truth(mesh, {liver}, scene);
  for (PolicyName policy : all_policies) {
    INFO(name(policy));
    const auto model = make_model(policy, mesh, scene, liver);
    const VectorX internal = model->internal_force(), reactions = model->reactions();
    Vector3 sum_internal = Vector3::Zero(), sum_reactions = Vector3::Zero(), sum_load = Vector3::Zero();
    for (Index i = 0; i < mesh.node_count(); ++i) {
      sum_internal += internal.segment<3>(3 * i);
      sum_reactions += reactions.segment<3>(3 * i);
      sum_load += truth.load.segment<3>(3 * i);
    }
    const double scale = largest(reactions);
    CHECK(largest(sum_internal) <= 10 * accuracy(policy) * scale);
    CHECK(largest(sum_reactions + sum_load) <= 100 * accuracy(policy) * scale);
    for (Index i = 0; i < mesh.node_count(); ++i)
      if (mesh.position(i)[0] > 0.0 && i != 3) CHECK(reactions.segment<3>(3 * i).isZero(0.0));
    CHECK(reactions[9] != 0.0);  // node 3 is displaced along x only
    CHECK(reactions[10] == 0.0);
  }
}

TEST_CASE("work of the loads is twice the stored energy", "[model][closed_form]") {
  const Scene scene = brick_scene().traction("x1", {5.0, 2.0, -10.0});
  const Reference truth(brick(), {liver}, scene);
  for (PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::conjugate_gradient}) {
    const auto model = make_model(policy, brick(), scene, liver);
    CHECK_THAT(model->strain_energy(), Catch::Matchers::WithinRel(0.5 * truth.load.dot(truth.displacement), 1e-8));
  }
}

TEST_CASE("a bar under uniaxial stress", "[model][closed_form]") {
  const Mesh<Tet4> mesh = box_tet4({0.2, 0.1, 0.1}, {2, 1, 1});
  Scene scene;
  scene.prescribe("x0", {0.0, std::nullopt, std::nullopt})
      .prescribe("y0", {std::nullopt, 0.0, std::nullopt})
      .prescribe("z0", {std::nullopt, std::nullopt, 0.0})
      .traction("x1", {100.0, 0.0, 0.0});
  const auto model = make_model(PolicyName::condensed_inverse, mesh, scene, liver);
  const double strain = 100.0 / liver.youngs_modulus;
  for (Index i = 0; i < mesh.node_count(); ++i) {
    const Vector3 x = mesh.position(i), u = model->displacement().segment<3>(3 * i);
    const Vector3 exact = strain * Vector3(x[0], -liver.poisson_ratio * x[1], -liver.poisson_ratio * x[2]);
    CHECK(largest(u - exact) <= 1e-13 * 0.2 * strain * 100);
  }
}

TEST_CASE("a model with few compliance slots keeps the columns requested last", "[model][lazy]") {
  const Mesh<Tet4> mesh = brick();
  const Reference truth(mesh, {liver}, brick_scene());
  for (PolicyName policy : {PolicyName::sparse_cholesky, PolicyName::condensed_cholesky}) {
    INFO(name(policy));
    SetupOptions options;
    options.compliance_slots = 3;
    const auto model = make_model(policy, mesh, brick_scene(), liver, options);
    const auto check = [&](int j) {
      const auto& nodes = model->touchable_nodes();
      for (std::size_t i = 0; i < nodes.size(); ++i) {
        const Matrix3 c = truth.compliance(nodes[i], nodes[static_cast<std::size_t>(j)]);
        CHECK(largest(model->compliance(static_cast<int>(i), j) - c) <= 1e-11);
      }
    };
    for (int round = 0; round < 3; ++round)
      for (int j = 0; j + 2 < 12; ++j) {
        const std::array three{j, j + 1, j + 2};
        REQUIRE(model->require_columns(three).ok());
        for (int v : three) check(v);
      }
    const std::array four{1, 2, 3, 5};
    CHECK(model->require_columns(four).has(StatusFlag::degraded_model));
    int available = 0;
    for (int v : four) {
      double elsewhere = 0.0;
      for (int i = 0; i < 12; ++i)
        if (i != v) elsewhere = std::max(elsewhere, largest(model->compliance(i, v)));
      if (elsewhere == 0.0) {
        // never the column of another vertex: the pushed vertex is compliant, all others do not move
        CHECK(model->compliance(v, v).isDiagonal());
        CHECK(model->compliance(v, v)(0, 0) > 0.0);
        CHECK(model->compliance_bound(v) >= model->compliance(v, v).norm());
        continue;
      }
      check(v);
      ++available;
    }
    CHECK(available == 3);
  }
}
