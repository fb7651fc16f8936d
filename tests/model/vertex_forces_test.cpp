// Displacements with forces on vertices: vectors of any size, and vertices that do not exist.
#include <palpate/testing/allocation_counter.hpp>

#include <limits>

#include "model/any_model.hpp"
#include "model/reference.hpp"

using namespace test;

namespace {

const std::array two{VertexForce{11, {0.02, 0.0, -0.1}}, VertexForce{5, {0.0, 0.03, -0.05}}};

std::unique_ptr<AnyModel> pressed(PolicyName policy = PolicyName::condensed_inverse) {
  return make_model(policy, brick(), loaded(brick_scene()), liver);
}

}  // namespace

TEST_CASE("a displacement vector of any size is resized", "[model][forces][extreme]") {
  for (const PolicyName policy : {PolicyName::condensed_inverse, PolicyName::conjugate_gradient}) {
    INFO(name(policy));
    const auto model = pressed(policy);
    VectorX expected(model->displacement().size());
    REQUIRE(model->displacement_with(two, expected).converged);
    for (const Index size : {0, 1, 107, 109, 5000}) {
      VectorX u = VectorX::Constant(size, 7.0);
      CHECK(model->displacement_with(two, u).converged);
      CHECK(u == expected);
      VectorX rest = VectorX::Constant(size, 7.0);
      CHECK(model->displacement_with({}, rest).converged);
      CHECK(rest == model->displacement());
    }
    const testing::AllocationScope scope;
    model->displacement_with(two, expected);
    CHECK(scope.allocations() == 0);
  }
}

TEST_CASE("a force on a vertex that does not exist is ignored and reported", "[model][forces][extreme]") {
  const auto model = pressed();
  VectorX expected, u;
  REQUIRE(model->displacement_with(two, expected).converged);
  constexpr int lowest = std::numeric_limits<int>::min(), highest = std::numeric_limits<int>::max();
  for (const int vertex : {-1, lowest, 12, 1000000, highest}) {
    INFO(vertex);
    const std::array forces{two[0], VertexForce{vertex, {1.0, 2.0, 3.0}}, two[1]};
    const SolveReport report = model->displacement_with(forces, u);
    CHECK_FALSE(report.converged);
    CHECK(report.relative_residual == infinity);
    CHECK(u == expected);
  }
  CHECK(model->displacement_with(two, u).converged);
}

TEST_CASE("displacements as new vectors", "[model][forces]") {
  using Model = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
  Model model(brick(), loaded(brick_scene()), liver);
  VectorX expected(model.displacement().size());
  REQUIRE(model.displacement_with(two, expected).converged);
  CHECK(model.displacement(two) == expected);
  CHECK(model.displacement({}) == model.displacement());
  const auto with = [&](const VertexForce& f) { return refusal([&] { model.displacement({&f, 1}); }); };
  for (const int vertex : {-1, 12}) {
    const SetupProblem p = with({vertex, {1.0, 0.0, 0.0}});
    CHECK(to_string(p.kind) == "index_out_of_range");
    CHECK(p.ids == std::vector<std::int64_t>{vertex});
    CHECK_THAT(p.hint, contains("12 vertices"));
  }
  CHECK(to_string(with({3, {0.0, infinity, 0.0}}).kind) == "non_finite");
  CHECK(model.displacement(two) == expected);
}
