// Coulomb friction compared with closed forms.
#include "contact/tool_session.hpp"

#include <palpate/core/rigid_motion.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <cmath>

using namespace palpate;
using Catch::Matchers::WithinAbs;
using Catch::Matchers::WithinRel;
using test::AnalyticTissue;
using test::round_tool;
using test::ToolSession;

namespace {

constexpr double flat = 10.0;  // [m] a radius so large that the sphere is flat over millimetres

ContactParameters rough(double coefficient) {
  ContactParameters p;
  p.friction = coefficient;
  return p;
}

/// Tangential force: across z.
double drag_of(const Vector3& force) {
  return force.head<2>().norm();
}

}  // namespace

TEST_CASE("a tick with the default tolerance has the friction of converged ticks while the direction of slip changes",
          "[contact][friction]") {
  const double own = 5e-3, mu = 0.3;
  const Vector3 centre(0.0, 0.0, 4e-3 - 1e-4);
  AnalyticTissue tissue(9, 1e-2, own), same(9, 1e-2, own);  // 1.25 mm apart: the contact moves over vertices
  ContactParameters exact = rough(mu);
  exact.maximum_iterations = 30;
  exact.force_tolerance = 1e-10;
  const Vector3 above = centre + Vector3(0.0, 0.0, 3e-4);
  ToolSession s(tissue, {round_tool(4e-3, above, 2e-3)}, rough(mu)),
      converged(same, {round_tool(4e-3, above, 2e-3)}, exact);
  double worst = 0.0;
  for (int k = 0; k < 600; ++k) {
    const double angle = 0.02 * k;
    const Vector3 at =
        k < 100
            ? Vector3(above + (centre - above) * k / 99.0)
            : Vector3(centre + 1e-3 * Vector3(std::cos(angle) - std::cos(2.0), std::sin(angle) - std::sin(2.0), 0.0));
    s.tick(0, at);
    converged.tick(0, at);
    if (k >= 100) worst = std::max(worst, (s.force() - converged.force()).norm() / converged.force().norm());
  }
  CHECK(worst <= 5e-3);
}

TEST_CASE("one point sticks like a spring up to mu N, slips at mu N, and sticks again when the motion reverses",
          "[contact][friction]") {
  for (const double own : {1e-4, 5e-3})
    for (const double coupling : {0.0, 2e-3})
      for (const double mu : {0.1, 0.5, 1.2}) {
        AnalyticTissue tissue(4, 0.2, own);  // 50 mm apart: the sphere touches one
        const double depth = 1e-4, soft = own + coupling, press = depth / soft;
        ToolSession s(tissue, {round_tool(flat, {0, 0, flat + 1e-5}, coupling)}, rough(mu));
        s.move(0, {0, 0, flat - depth}, 50);
        s.settle(3);
        INFO("own " << own << ", coupling " << coupling << ", mu " << mu);
        CHECK_THAT(s.force()[2], WithinRel(press, 1e-4));
        CHECK(drag_of(s.force()) <= 1e-6 * press);

        const double slip_at = mu * depth;  // [m] where the spring reaches mu N
        const Vector3 along = Vector3(0.6, -0.8, 0.0);
        double worst_stick = 0.0, worst_slip = 0.0, worst_turn = 0.0, sideways = 0.0, jump = 0.0;
        Vector3 before = s.force();
        for (int k = 1; k <= 300; ++k) {
          const double x = 0.01 * k * slip_at;
          s.tick(0, Vector3(0, 0, flat - depth) + x * along);
          const double drag = -along.dot(s.force()), expected = mu * press * std::min(1.0, x / slip_at);
          (x < slip_at ? worst_stick : worst_slip) =
              std::max(x < slip_at ? worst_stick : worst_slip, std::abs(drag - expected) / (mu * press));
          sideways = std::max(sideways, (s.force() + drag * along).head<2>().norm() / (mu * press));
          jump = std::max(jump, (s.force() - before).norm() / (mu * press));
          before = s.force();
        }
        CHECK(worst_stick <= 2e-3);
        CHECK(worst_slip <= 2e-3);  // 1 % required
        CHECK(sideways <= 2e-3);
        CHECK(jump <= 0.011);  // a hundredth of the displacement to slip per tick: no jump at the end of sticking
        const double end = 3.0 * slip_at;
        for (int k = 1; k <= 400; ++k) {
          const double back = 0.01 * k * slip_at;
          s.tick(0, Vector3(0, 0, flat - depth) + (end - back) * along);
          const double expected = mu * press * std::max(-1.0, 1.0 - back / slip_at);
          worst_turn = std::max(worst_turn, std::abs(-along.dot(s.force()) - expected) / (mu * press));
        }
        CHECK(worst_turn <= 5e-3);
        CHECK(s.status.ok());
      }
}

TEST_CASE("the friction force of many points together is mu N in any direction", "[contact][friction]") {
  testing::Random random(71);
  double worst = 0.0, worst_direction = 0.0, roughest = 0.0;
  std::size_t most = 0;
  for (const double common : {0.0, 1e-3})
    for (const double mu : {0.05, 0.3, 0.8})
      for (int run = 0; run < 4; ++run) {
        AnalyticTissue tissue(6, 0.06, 2e-3, common);  // 10 mm apart
        ToolSession s(tissue, {round_tool(2.0, {0, 0, 2.0 + 1e-5}, 2e-3)}, rough(mu));
        s.move(0, {0, 0, 2.0 - 4e-4}, 100);
        const double angle = random.uniform(0.0, 6.28);
        const Vector3 along(std::cos(angle), std::sin(angle), 0.0), start = s.tools[0].target;
        Vector3 before = s.force();
        for (int k = 1; k <= 400; ++k) {
          s.tick(0, start + 5e-6 * k * along);
          roughest = std::max(roughest, (s.force() - before).norm() / s.force().norm());
          before = s.force();
          if (k < 250) continue;
          const double ratio = drag_of(s.force()) / s.force()[2];
          worst = std::max(worst, std::abs(ratio / mu - 1.0));
          worst_direction = std::max(worst_direction, 1.0 + along.dot(s.force()) / drag_of(s.force()));
        }
        most = std::max(most, s.problem.contacts().size());
        CHECK_FALSE(s.status.has(StatusFlag::solver_not_converged));
      }
  INFO("largest error of friction force over mu N " << worst << ", direction " << worst_direction << ", tick to tick "
                                                    << roughest << ", up to " << most << " points");
  CHECK(worst <= 0.01);
  CHECK(worst_direction <= 1e-3);
  CHECK(roughest <= 0.05);
  CHECK(most >= 9);
}

TEST_CASE("the friction force on a sphere of 4 mm that slides over many points is smooth", "[contact][friction]") {
  AnalyticTissue tissue(40, 0.02, 2e-2, 1e-3);  // half a millimetre apart
  ToolSession s(tissue, {round_tool(4e-3, {-4e-3, 0, 4.1e-3}, 2e-3)}, rough(0.4));
  s.move(0, {-4e-3, 0, 3.4e-3}, 100);
  double sum = 0.0, roughest = 0.0, press = 0.0;
  Vector3 before = s.force();
  int count = 0;
  for (int k = 1; k <= 600; ++k) {
    s.tick(0, Vector3(-4e-3 + 1e-5 * k, 0, 3.4e-3));
    if (k > 150) {
      sum -= s.force()[0];
      press += s.force()[2];
      roughest = std::max(roughest, (s.force() - before).norm() / s.force().norm());
      ++count;
    }
    before = s.force();
  }
  INFO("mean friction force over press " << sum / press << ", tick to tick " << roughest);
  // With contact normals that spread by 0.3 rad only a part of the friction is lateral; the dent adds a lateral force.
  CHECK(sum / press >= 0.3);
  CHECK(sum / press <= 0.5);
  CHECK(roughest <= 0.02);
}

TEST_CASE("a sphere that slips from one point to the next keeps its friction", "[contact][friction]") {
  for (const double mu : {0.4, 0.9})
    for (const double angle : {0.0, 0.4}) {
      AnalyticTissue tissue(16, 0.032, 1e-5);  // 2 mm apart and stiff: the sphere rests on one to four points
      const Vector3 along(std::cos(angle), std::sin(angle), 0.0), start(-8e-3, -1e-3, 7e-3);
      ToolSession s(tissue, {round_tool(8e-3, {-8e-3, -1e-3, 8.1e-3}, 2e-3)}, rough(mu));
      s.move(0, start, 100);
      double least = 1.0, largest_change = 0.0;
      Vector3 before = s.force();
      for (int k = 1; k <= 800; ++k) {
        s.tick(0, start + 2e-5 * k * along);
        if (k > 300) {
          least = std::min(least, -along.dot(s.force()) / s.force().norm());
          largest_change = std::max(largest_change, (s.force() - before).norm() / s.force().norm());
        }
        before = s.force();
      }
      INFO("mu " << mu << ", angle " << angle << ": least friction over force " << least << ", largest change "
                 << largest_change);
      // The surface through points 2 mm apart is inclined by 0.13, and a slip from point to point takes one tick.
      CHECK(least >= std::sin(std::atan(mu) - 0.26));
      CHECK(largest_change <= 0.3);
    }
}

TEST_CASE("friction never generates energy for any motion of the hand", "[contact][friction][energy]") {
  testing::Random random(72);
  for (const double coupling : {0.0, 2e-3}) {
    AnalyticTissue tissue(6, 0.06, 5e-4, 5e-4);
    ToolSession s(tissue, {round_tool(2.0, {0, 0, 2.0 + 1e-4}, coupling)}, rough(0.6));
    const Vector3 home(0, 0, 2.0 + 1e-4);
    Vector3 velocity = Vector3::Zero();
    double work = 0.0, taken = 0.0;
    const auto step = [&](const Vector3& to) {
      const Vector3 before = s.force(), at = s.tools[0].target;
      s.tick(0, to);
      const double w = 0.5 * (before + s.force()).dot(s.tools[0].target - at);
      work += w;
      if (w < 0.0) taken -= w;
    };
    for (int k = 0; k < 4000; ++k) {
      const Vector3 push(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1));
      velocity = 0.98 * velocity + 2e-6 * push;
      step(s.tools[0].target + velocity + 0.01 * (home - Vector3(0, 0, 4e-4) - s.tools[0].target));
    }
    const Vector3 last = s.tools[0].target;
    for (int k = 1; k <= 200; ++k) step(last + (home + Vector3(0, 0, 1e-3) - last) * k / 200);
    INFO("coupling " << coupling << ": the hand supplied " << taken << " J and lost " << -work);
    CHECK(s.force() == Vector3::Zero());
    CHECK(work <= 0.0);
    CHECK(-work >= 0.05 * taken);
  }
}

TEST_CASE("a sphere that spins against friction has a torque about its centre", "[contact][friction][torque]") {
  AnalyticTissue tissue(4, 0.2, 1e-3);
  const double radius = 0.01, depth = 2e-5, mu = 0.5;
  ToolSession s(tissue, {round_tool(radius, {0, 0, radius + 1e-5}, 0.0)}, rough(mu));
  s.move(0, {0, 0, radius - depth}, 20);
  const double press = s.force()[2];
  Matrix3 turn = Matrix3::Identity();
  for (int k = 1; k <= 400; ++k) {  // about y, on the spot
    turn = rotation_by(Vector3(0, 1e-4 * k, 0));
    s.tick(0, s.tools[0].target, turn);
  }
  // The point it spins over is moved along x; the friction force on the sphere is mu N against that, at its radius.
  CHECK_THAT(drag_of(s.force()), WithinRel(mu * press, 0.01));
  CHECK_THAT(s.tools[0].torque[1], WithinRel(-mu * press * radius, 0.02));
}

TEST_CASE("two tools with friction far apart do not interact", "[contact][friction]") {
  AnalyticTissue tissue(40, 0.04, 2e-2);
  const auto at = [](double x) { return round_tool(4e-3, {x, 2e-4, 4.1e-3}, 1e-3); };
  ToolSession both(tissue, {at(-0.01), at(0.01)}, rough(0.5)), one(tissue, {at(-0.01)}, rough(0.5)),
      other(tissue, {at(0.01)}, rough(0.5));
  for (int k = 1; k <= 200; ++k) {
    const Vector3 by(5e-6 * k, -2e-6 * k, -3e-6 * k);
    const Vector3 a = Vector3(-0.01, 2e-4, 4.1e-3) + by, b = Vector3(0.01, 2e-4, 4.1e-3) + 0.9 * by;
    both.tick(0, a);
    both.tick(1, b);
    for (int twice = 0; twice < 2; ++twice) {
      one.tick(0, a);
      other.tick(0, b);
    }
  }
  CHECK(drag_of(one.force()) > 0.05 * one.force()[2]);
  CHECK((both.force(0) - one.force()).norm() <= 2e-3 * one.force().norm());
  CHECK((both.force(1) - other.force()).norm() <= 2e-3 * other.force().norm());
}

TEST_CASE("invalid coefficients of friction are refused", "[contact][friction]") {
  AnalyticTissue tissue(4, 0.02, 1e-3);
  for (const double bad : {-0.1, 4.1, infinity, std::numeric_limits<double>::quiet_NaN()})
    CHECK_THROWS_AS(ToolSession(tissue, {}, rough(bad)), SetupError);
}
