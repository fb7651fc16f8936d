// Extremes of the material: refused, flagged, or right.
#include <palpate/testing/tissue_laws.hpp>

#include "extremes/verdict.hpp"

using namespace test;

namespace {

Scene scene() {
  return brick_scene().traction("x1", {1.0, 0.5, -2.0});
}

bool iterative(PolicyName p) {
  return p == PolicyName::conjugate_gradient || p == PolicyName::condensed_conjugate_gradient;
}

/// The brick in two materials: the first near the support, or in every other element.
Mesh<Tet4> two_materials(bool halves) {
  Mesh<Tet4> mesh = brick();
  mesh.region_names = {"first", "second"};
  for (Index e = 0; e < mesh.element_count(); ++e) {
    const double x = element_nodes<Tet4>(mesh, e).col(0).mean();
    mesh.regions.push_back(halves ? (x < 0.04 ? 0 : 1) : static_cast<int>(e % 2));
  }
  return mesh;
}

}  // namespace

TEST_CASE("inadmissible Poisson ratios never become a model", "[extreme][A1]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (double nu : {0.5, 0.6, 1.0, -1.0, -1.5, 1e300, infinity, -infinity, nan, std::nextafter(-1.0, -2.0)}) {
    const SetupProblem p = refusal([&] {
      make_model(PolicyName::condensed_inverse, brick(), scene(), {5e3, nu, 0.0});
    });
    CHECK(to_string(p.kind) == "bad_poisson_ratio");
    CHECK(p.ids == std::vector<std::int64_t>{0});
    CHECK_THAT(p.what, contains("body"));
  }
}

TEST_CASE("Poisson ratios towards one half", "[extreme][A2]") {
  for (double nu : {0.4, 0.45, 0.49, 0.499, 0.4999, 0.49999, 0.4999999, 0.5 * (1 - 1e-8), 0.5 * (1 - 1e-10),
                    0.5 * (1 - 1e-12), 0.5 * (1 - 1e-14), std::nextafter(0.5, 0.0)}) {
    const LinearElastic m{5e3, nu, 0.0};
    judge_all("nu " + number(nu), brick(), {m}, scene(), [&](PolicyName policy, const Outcome& o) {
      if (nu <= 0.4999 && !iterative(policy) && policy != PolicyName::condensed_float)
        CHECK(o.verdict == Verdict::right);
      if (o.verdict == Verdict::refused) return;
      const auto model = make_model(policy, brick(), scene(), m);
      CHECK(model->report().has(SetupFlag::locking) == (nu > 0.4));
    });
  }
}

TEST_CASE("Poisson ratios towards minus one: auxetic", "[extreme][A1][A2]") {
  for (double nu : {0.0, -0.5, -0.9, -0.999, -1 + 1e-6, -1 + 1e-9, -1 + 1e-12, std::nextafter(-1.0, 0.0)})
    judge_all("nu " + number(nu), brick(), {{5e3, nu, 0.0}}, scene(), [&](PolicyName policy, const Outcome& o) {
      if (nu >= -0.9 && policy != PolicyName::condensed_float) CHECK(o.verdict == Verdict::right);
    });
}

TEST_CASE("the error does not depend on Young's modulus", "[extreme][A3]") {
  for (double young : {1e-6, 1.0, 1e2, 1e4, 1e6, 1e9, 1e12}) {
    const LinearElastic m{young, 0.3, 0.0};
    judge_all("E " + number(young), brick(), {m}, scene(), [&](PolicyName policy, const Outcome& o) {
      CHECK(o.error <= (policy == PolicyName::condensed_float ? 1e-4 : iterative(policy) ? 1e-9 : 1e-12));
    });
  }
}

TEST_CASE("the tissue laws hold for soft and for stiff bodies", "[extreme][A3]") {
  for (double young : {1.0, 1e4, 1e9, 1e12})
    for (PolicyName policy : extreme_policies) {
      INFO("E " << young << ", " << name(policy));
      const auto model = make_model(policy, brick(), scene(), {young, 0.3, 0.0});
      CHECK(testing::describe(testing::tissue_laws(*model, all_vertices(12), {accuracy(policy)})) == "");
    }
}

TEST_CASE("stiff and soft materials in one body", "[extreme][A4]") {
  for (bool halves : {true, false})
    for (double contrast : {1e3, 1e6, 1e9, 1e12, 1e15})
      for (bool hard_first : {true, false}) {
        const LinearElastic soft{1e3, 0.3, 0.0}, hard{contrast * 1e3, 0.3, 0.0};
        const std::vector<LinearElastic> materials{hard_first ? hard : soft, hard_first ? soft : hard};
        const std::string what = "contrast " + number(contrast) + (halves ? ", halves" : ", mixed") +
                                 (hard_first ? ", stiff end fixed" : "");
        judge_all(what, two_materials(halves), materials, scene(), [&](PolicyName policy, const Outcome& o) {
          if (contrast <= 1e6 && (policy == PolicyName::sparse_cholesky || policy == PolicyName::condensed_inverse))
            CHECK(o.verdict == Verdict::right);
        });
      }
}

TEST_CASE("invalid moduli and densities are refused", "[extreme][A5]") {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto kind = [](const LinearElastic& m) {
    return refusal([&] { make_model(PolicyName::condensed_inverse, brick(), scene(), m); }).kind;
  };
  for (double young : {0.0, -1.0, nan, infinity, -infinity})
    CHECK(to_string(kind({young, 0.3, 1.0})) == "bad_youngs_modulus");
  for (double density : {-1.0, nan, infinity, -1e-300}) CHECK(to_string(kind({1.0, 0.3, density})) == "bad_density");
  CHECK(to_string(kind({1e308, 0.4999999999, 1.0})) == "not_positive_definite");
}

TEST_CASE("moduli at the ends of the number range", "[extreme][A3][A5]") {
  for (double young : {1e-300, 1e-150, 1e150, 1e290})
    judge_all("E " + number(young), brick(), {{young, 0.3, 0.0}},
              brick_scene().prescribe("x1", {1e-3, std::nullopt, std::nullopt}), [](PolicyName, const Outcome&) {});
}
