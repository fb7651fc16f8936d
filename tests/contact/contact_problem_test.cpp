// Spheres on a tissue whose contact force has a closed form.
#include "contact/tool_session.hpp"

#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using test::AnalyticTissue;

namespace {

constexpr double radius = 4e-3;

/// Spacing of contact points so large that they are at the vertices only, as the closed form assumes.
constexpr double vertices_only = 1e3 * radius;

std::vector<ContactTool> spheres(const std::vector<Vector3>& start, double coupling_compliance) {
  std::vector<ContactTool> tools;
  for (const Vector3& at : start) tools.push_back(test::round_tool(radius, at, coupling_compliance));
  return tools;
}

/// One or more spheres that are moved in steps, as a servo does.
struct Session : test::ToolSession {
  Session(AnalyticTissue& t, const std::vector<Vector3>& start, double coupling_compliance,
          double sampled_for = vertices_only, const ContactParameters& parameters = {.capacity = 48})
      : ToolSession(t, spheres(start, coupling_compliance), parameters, sampled_for) {}
  /// In equal steps of at most `step`.
  void move(std::size_t i, const Vector3& target, double step = 5e-5) {
    const double path = (target - tools[i].target).norm();
    ToolSession::move(i, target, std::max(1, static_cast<int>(std::ceil(path / step))));
  }
};

}  // namespace

TEST_CASE("one contact: force is penetration over tissue plus coupling compliance", "[contact][problem]") {
  for (double own : {1e-4, 1e-2})
    for (double coupling : {0.0, 2e-3, 1e-1}) {
      AnalyticTissue tissue(4, 0.2, own);  // vertices 50 mm apart
      for (double depth : {1e-6, 1e-4, 1e-3, 3e-3}) {
        Session s(tissue, {Vector3(0, 0, radius + 1e-4)}, coupling);
        s.move(0, Vector3(0, 0, radius - depth));
        INFO("own " << own << ", coupling " << coupling << ", depth " << depth);
        CHECK_THAT(s.force()[2], WithinRel(depth / (own + coupling), 1e-5));
        CHECK(s.force().head<2>().norm() <= 1e-12 * s.force()[2]);
        CHECK_THAT(s.tools[0].proxy[2], WithinAbs(radius - depth + coupling * s.force()[2], 1e-9));
        CHECK(s.status == Status{});
        s.problem.force_error(tissue, 0, s.tools[0]);
        CHECK(s.problem.status_of(0, s.tools[0]) == Status(StatusFlag::coarse_contact));  // its material is not known
      }
    }
}

TEST_CASE("a contact beside a vertex pushes along the line to the sphere's centre", "[contact][problem]") {
  AnalyticTissue tissue(4, 0.2, 1e-3);
  const Vector3 direction = Vector3(0.3, -0.2, 1.0).normalized();
  Session s(tissue, {direction * (radius + 1e-4)}, 0.0);
  s.move(0, direction * (radius - 5e-4));
  s.settle();
  CHECK((s.force() - direction * 0.5).norm() <= 1e-5);
}

TEST_CASE("many contacts: the force equals the closed form", "[contact][problem]") {
  testing::Random random(61);
  for (double common : {0.0, 2e-3})
    for (double coupling : {0.0, 2e-3}) {
      AnalyticTissue tissue(20, 0.02, 2e-2, common);  // vertices 1 mm apart
      double worst = 0.0;
      std::size_t most = 0;
      for (int i = 0; i < 25; ++i) {
        const Vector3 start(random.uniform(-3e-3, 3e-3), random.uniform(-3e-3, 3e-3), radius + 1e-4);
        const Vector3 end =
            start + Vector3(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), -random.uniform(2e-4, 1.5e-3));
        Session s(tissue, {start}, coupling);
        s.move(0, end);
        s.settle();
        const Vector3 exact = tissue.exact_force(end, radius, coupling);
        worst = std::max(worst, (s.force() - exact).norm() / exact.norm());
        most = std::max(most, s.problem.contacts().size());
        CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
      }
      INFO("common " << common << ", coupling " << coupling << ", up to " << most << " contacts");
      CHECK(worst <= 1e-4);
      CHECK(most >= 12);
    }
}

TEST_CASE("a static sphere gives the same force in every tick", "[contact][problem][M10]") {
  AnalyticTissue tissue(20, 0.02, 2e-2, 1e-3);
  Session s(tissue, {Vector3(2e-4, -3e-4, radius + 1e-4)}, 2e-3);
  s.move(0, Vector3(5e-4, -1e-4, radius - 1e-3));
  const Vector3 first = s.force();
  s.settle(10);
  const Vector3 later = s.force();
  s.settle(1000);
  CHECK((first - later).norm() <= 2e-3 * later.norm());
  CHECK((s.force() - later).norm() <= 1e-9 * later.norm());
}

TEST_CASE("two spheres far apart on independent springs do not interact", "[contact][problem]") {
  AnalyticTissue tissue(40, 0.04, 2e-2);
  const Vector3 a(-0.01, 2e-4, radius + 1e-4), b(0.01, -1e-4, radius + 1e-4), down(0, 0, -1.1e-3);
  Session one(tissue, {a}, 1e-3), other(tissue, {b}, 1e-3), both(tissue, {a, b}, 1e-3);
  one.move(0, a + down);
  other.move(0, b + down);
  both.move(0, a + down);
  both.move(1, b + down);
  for (Session* s : {&one, &other, &both}) s->settle();
  CHECK(one.force().norm() > 0.1);
  CHECK((both.force(0) - one.force()).norm() <= 1e-9);
  CHECK((both.force(1) - other.force()).norm() <= 1e-9);
}

TEST_CASE("two spheres on a common spring reduce each other's force as computed by hand", "[contact][problem]") {
  const double own = 1e-3, common = 2e-3, coupling = 5e-4, depth = 1e-3;
  AnalyticTissue tissue(4, 0.2, own, common);
  const Vector3 a(-0.05, 0, radius + 1e-4), b(0.05, 0, radius + 1e-4);
  Session s(tissue, {a, b}, coupling);
  s.move(0, Vector3(-0.05, 0, radius - depth));
  CHECK_THAT(s.force(0)[2], WithinRel(depth / (own + common + coupling), 1e-5));
  CHECK(s.force(1) == Vector3::Zero());
  s.move(1, Vector3(0.05, 0, radius - depth));
  for (std::size_t i : {0u, 1u}) CHECK_THAT(s.force(i)[2], WithinRel(depth / (own + 2.0 * common + coupling), 1e-5));
  s.tools[0].active = false;  // lifted off
  s.settle(1);
  CHECK_THAT(s.force(1)[2], WithinRel(depth / (own + common + coupling), 1e-5));
}

TEST_CASE("the rendered stiffness never exceeds the coupling for any number of contacts", "[contact][problem]") {
  testing::Random random(62);
  for (double own : {1e-10, 1e-6, 1e-3})
    for (int cells : {4, 20, 40}) {
      AnalyticTissue tissue(cells, 0.02, own);
      const double k = 500.0;
      double worst = 0.0, worst_spring = 0.0, stiffest = 0.0;
      std::size_t most = 0;
      for (int i = 0; i < 10; ++i) {
        const Vector3 start(random.uniform(-3e-3, 3e-3), random.uniform(-3e-3, 3e-3), radius + 1e-4);
        Session s(tissue, {start}, 1.0 / k, radius);
        Vector3 before = Vector3::Zero();
        for (int n = 0; n < 60; ++n) {
          s.tick(0, start - Vector3(0, 0, 2e-5 * n));
          const double depth = std::max(0.0, radius - s.tools[0].target[2]);
          worst = std::max(worst, s.force().norm() - k * depth);
          worst_spring = std::max(worst_spring, (s.force() - k * (s.tools[0].proxy - s.tools[0].target)).norm());
          if (depth > 0.0) stiffest = std::max(stiffest, (s.force() - before).norm() / 2e-5);
          before = s.force();
          most = std::max(most, s.problem.contacts().size());
        }
      }
      INFO("own " << own << ", " << cells << " cells, up to " << most << " contacts");
      CHECK(worst <= 1e-6);
      CHECK(worst_spring <= 1e-6);
      CHECK(stiffest <= k * (1.0 + 2e-3));
      CHECK(stiffest >= 0.5 * k / (1.0 + k * own));
    }
}

TEST_CASE("the sphere penetrates no contact point and is pushed out, not in", "[contact][problem]") {
  testing::Random random(63);
  for (double sampled_for : {radius, vertices_only}) {
    AnalyticTissue tissue(8, 0.02, 1e-2, 1e-3);  // 2.5 mm apart: the lattice matters
    const detail::ContactSamples samples(tissue.contact_surface(), 0.5 * sampled_for);
    double deepest = infinity;
    int inward = 0, pulling = 0, touching = 0;
    for (int i = 0; i < 60; ++i) {
      const Vector3 start(random.uniform(-5e-3, 5e-3), random.uniform(-5e-3, 5e-3), radius + 1e-4);
      Session s(tissue, {start}, i % 2 == 0 ? 0.0 : 2e-3, sampled_for);
      s.move(0,
             start + Vector3(random.uniform(-1e-3, 1e-3), random.uniform(-1e-3, 1e-3), -random.uniform(2e-4, 1.2e-3)));
      s.settle();
      if (s.force().norm() > 0.0) ++touching;
      deepest = std::min(deepest, smallest_gap(tissue, samples, s.problem.vertex_forces(), s.tools[0].proxy, radius));
      if (!(s.force()[2] >= 0.0)) ++inward;
      for (const Contact& c : s.problem.contacts())
        if (!(c.force >= 0.0) || !(c.force * c.normal[2] >= 0.0)) ++pulling;
    }
    INFO("contact points for a radius of " << sampled_for);
    CHECK(touching >= 50);
    CHECK(deepest >= -1e-5 * radius);
    CHECK(inward == 0);
    CHECK(pulling == 0);
  }
}

TEST_CASE("forces on the tissue are the forces on the spheres, and balance them", "[contact][problem]") {
  AnalyticTissue tissue(16, 0.02, 1e-2, 1e-3);
  Session s(tissue, {Vector3(-3e-3, 0, radius + 1e-4), Vector3(4e-3, 1e-3, radius + 1e-4)}, 1e-3, radius);
  s.move(0, Vector3(-2.9e-3, 1e-4, radius - 8e-4));
  s.move(1, Vector3(4.1e-3, 1e-3, radius - 4e-4));
  Vector3 on_tissue = Vector3::Zero(), on_contacts = Vector3::Zero();
  for (const VertexForce& f : s.problem.vertex_forces()) on_tissue += f.force.in_model_axes();
  for (const Contact& c : s.problem.contacts()) on_contacts += c.force * c.normal;
  const Vector3 on_tools = s.force(0) + s.force(1);
  CHECK((on_tissue + on_tools).norm() <= 1e-12);
  CHECK((on_contacts - on_tools).norm() <= 1e-12);
  s.problem.reset();
  CHECK(s.problem.contacts().empty());
  CHECK(s.problem.vertex_forces().empty());
}

namespace {

/// Work of the tissue on a rigidly coupled sphere that is pressed in, slid, released and moved back through the air,
/// divided by the work of the press. Trapezoid rule.
double work_of_loop(const ContactParameters& parameters, double sampled_for, int cells, double step) {
  AnalyticTissue tissue(cells, 0.02, 2e-2);
  Session s(tissue, {Vector3(-1.3e-3, -4e-4, radius + 1e-4)}, 0.0, sampled_for, parameters);
  double work = 0.0;
  const auto go = [&](const Vector3& by) {
    const Vector3 from = s.tools[0].target;
    const int n = static_cast<int>(std::lround(by.norm() / step));
    for (int k = 1; k <= n; ++k) {
      const Vector3 before = s.force(), at = s.tools[0].target;
      s.tick(0, from + by * k / n);
      work += 0.5 * (before + s.force()).dot(s.tools[0].target - at);
    }
  };
  const Vector3 slide(3e-3, 7e-4, 0.0), down(0, 0, -1.1e-3);
  go(down);
  const double press = -work;
  go(slide);
  go(-down);
  go(-slide);
  return work / press;
}

}  // namespace

TEST_CASE("a closed path under rigid coupling yields no work", "[contact][problem][energy]") {
  for (int cells : {20, 8}) {  // every contact point a vertex; points on edges and faces too
    INFO(cells << " cells");
    const double sampled_for = cells == 20 ? vertices_only : radius;
    // As in a servo, linearisation stops when the force changes by a thousandth. The remaining error is the rotation of
    // the normals in one step: it dissipates and never drives.
    for (double step : {2e-5, 1e-5, 2.5e-6}) {
      const double work = work_of_loop({}, sampled_for, cells, step);
      INFO(cells << " cells, steps of " << 1e6 * step << " um: work of the loop over work of the press " << work);
      CHECK(work <= 1e-4);
      CHECK(work >= -2e-2);
    }
    ContactParameters strict;
    strict.force_tolerance = 1e-7;
    const double coarse = work_of_loop(strict, sampled_for, cells, 2e-5),
                 fine = work_of_loop(strict, sampled_for, cells, 5e-6);
    strict.maximum_iterations = 30;
    const double converged = work_of_loop(strict, sampled_for, cells, 2e-5);
    INFO(cells << " cells, four linearisations always: " << coarse << " in 20 um steps, " << fine
               << " in 5 um steps; to convergence: " << converged);
    CHECK(std::abs(coarse) <= 5e-3);
    CHECK(std::abs(fine) <= 0.4 * std::abs(coarse));
    CHECK(std::abs(converged) <= 2e-4);
  }
}

TEST_CASE("the work of a press is the stored energy", "[contact][problem][energy]") {
  AnalyticTissue tissue(20, 0.02, 2e-2);
  const Vector3 start(3e-4, 2e-4, radius + 1e-4), end(1e-3, 2e-4, radius - 1e-3);
  Session s(tissue, {start}, 0.0);
  double work = 0.0;
  for (int k = 1; k <= 2000; ++k) {
    const Vector3 before = s.force(), at = s.tools[0].target;
    s.tick(0, start + (end - start) * k / 2000);
    work -= 0.5 * (before + s.force()).dot(s.tools[0].target - at);
  }
  CHECK_THAT(work, WithinRel(tissue.energy(end, radius), 1e-3));
}

TEST_CASE("more contacts than the capacity: flagged, all rows below the sphere, force finite",
          "[contact][problem][extreme][D4]") {
  AnalyticTissue tissue(60, 0.02, 2e-2);  // a third of a millimetre apart
  Session s(tissue, {Vector3(0, 0, radius + 1e-4)}, 2e-3, vertices_only, {.capacity = 8});
  s.move(0, Vector3(0, 0, radius - 1e-3));
  CHECK(s.status == Status(StatusFlag::degraded_model));  // solved for the contacts that fit
  for (const Contact& c : s.problem.contacts())
    CHECK(c.rest.head<2>().norm() < std::sqrt(2e-3 * radius));  // below the sphere, not beside it
  CHECK(s.problem.contacts().size() >= 4);
  CHECK(s.force().allFinite());
  CHECK(s.force()[2] > 0.0);
  CHECK(s.force().norm() <= 500.0 * 1e-3 * (1.0 + 1e-6));
}

TEST_CASE("a sphere in the air has exactly zero force and no contacts", "[contact][problem]") {
  AnalyticTissue tissue(20, 0.02, 2e-2);
  Session s(tissue, {Vector3(0, 0, 0.05)}, 2e-3, radius);
  s.move(0, Vector3(3e-3, 0, 0.02), 1e-3);
  s.settle(3);
  CHECK(s.force() == Vector3::Zero());
  CHECK(s.problem.contacts().empty());
  CHECK(s.tools[0].proxy == s.tools[0].target);
  s.move(0, Vector3(3e-3, 0, -0.02), 1e-4);  // right through: a linear tissue deforms to any depth
  s.move(0, Vector3(3e-3, 0, 0.05), 1e-4);
  s.settle(3);
  CHECK(s.force() == Vector3::Zero());
}

TEST_CASE("invalid targets have no effect on later ticks", "[contact][problem][extreme][D1]") {
  AnalyticTissue tissue(20, 0.02, 2e-2);
  const Vector3 above(2e-4, 1e-4, radius + 1e-4), pressed(2e-4, 1e-4, radius - 8e-4);
  Session reference(tissue, {above}, 2e-3);
  reference.move(0, pressed);
  reference.settle();
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), infinity, 1e308}) {
    Session s(tissue, {above}, 2e-3);
    s.move(0, pressed);
    s.tick(0, Vector3(0.0, bad, 0.0));
    // As a servo does when contact restarts.
    s.tools[0].target = s.tools[0].proxy = above;
    s.tools[0].force.setZero();
    s.settle(2);
    s.move(0, pressed);
    s.settle();
    CHECK((s.force() - reference.force()).norm() <= 1e-6 * reference.force().norm());
  }
}

TEST_CASE("a sphere that slips off a point it balances on: a flag before rounding decides the force",
          "[contact][problem]") {
  // Without friction the balance is unstable once the device is below the point: the coupling is softer than the push
  // to the side. A billionth of the radius to either side stands for rounding.
  for (const double step : {1e-5, 2e-5, 5e-5, 1e-4, 2e-4})
    for (const double beside : {1e-9 * radius, 1e-6 * radius}) {
      AnalyticTissue tissue(4, 4.8 * radius, 1e-3);
      Session left(tissue, {{-beside, 0.0, 1.01 * radius}}, 2e-3), right(tissue, {{beside, 0.0, 1.01 * radius}}, 2e-3);
      bool differs = false;
      for (double z = 1.01 * radius; z > -2.0 * radius && !differs; z -= step) {
        left.tick(0, {-beside, 0.0, z});
        right.tick(0, {beside, 0.0, z});
        differs = (left.force() - right.force()).norm() > 0.05 * left.force().norm();
      }
      INFO("step " << step << ", beside " << beside);
      CHECK(differs);
      CHECK((left.status | right.status).has(StatusFlag::solver_not_converged));
    }
}
