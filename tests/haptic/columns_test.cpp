// Whole surfaces touched without a stored compliance: columns computed in the tick, or in a background thread.
#include "contact/servo_session.hpp"

#include <palpate/linear/sparse_cholesky.hpp>

#include "catch.hpp"

#include <chrono>
#include <numeric>
#include <thread>

using namespace palpate;
using test::pad_height;
using test::ServoSession;
using test::sphere_radius;

namespace {

using Sparse = HapticFEModel<Tet4, LinearElastic, SparseCholesky>;

Sparse make_model(ColumnFill fill, int slots = 256) {
  SetupOptions options;
  options.columns = fill;
  options.compliance_slots = slots;
  return test::make_pad<Sparse>("surface", 1e4, {6, 6, 4}, options);
}

/// Ticks at one place until no column is missing; false if that does not happen within some seconds.
bool settle(ServoSession<Sparse>& session) {
  int complete = 0;
  for (int i = 0; i < 20'000 && complete < 20; ++i) {
    complete = session.tick().status.has(StatusFlag::degraded_model) ? 0 : complete + 1;
    std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  return complete == 20;
}

}  // namespace

TEST_CASE("columns computed in a thread give the same final force as columns computed in the tick",
          "[haptic][columns]") {
  Sparse asynchronous = make_model(ColumnFill::asynchronous), synchronous = make_model(ColumnFill::synchronous);
  ServoSession session(asynchronous), reference(synchronous);
  for (double x : {0.009, 0.0137, 0.021}) {
    session.press(2e-3, x);
    reference.press(2e-3, x);
    REQUIRE(settle(session));
    reference.hold(50);
    const Vector3 f = session.servo.tick_view().contact_force(), g = reference.servo.tick_view().contact_force();
    CHECK((f - g).norm() <= 1e-3 * g.norm());
  }
}

TEST_CASE("a tick without a flag has the force of complete columns, also right after they arrived",
          "[haptic][columns]") {
  Sparse asynchronous = make_model(ColumnFill::asynchronous), synchronous = make_model(ColumnFill::synchronous);
  ServoSession session(asynchronous), reference(synchronous);
  int late = 0;
  for (const double x : {0.007, 0.011, 0.015, 0.019, 0.023}) {
    for (ServoSession<Sparse>* s : {&session, &reference})
      s->states[0].position = Vector3(x, 0.015, pad_height + sphere_radius - 1.5e-3);
    for (int tick = 0; tick < 12; ++tick) {
      const bool flagged = session.tick().status.has(StatusFlag::degraded_model);
      reference.tick();
      std::this_thread::sleep_for(std::chrono::milliseconds(10));  // the thread completes what this tick asked for
      late += flagged ? 1 : 0;
      const Vector3 f = session.servo.tick_view().contact_force(), g = reference.servo.tick_view().contact_force();
      INFO("x " << x << ", tick " << tick << ", " << f.transpose() << " instead of " << g.transpose());
      CHECK((flagged || (f - g).norm() <= 0.02 * g.norm()));
    }
  }
  CHECK(late > 0);
}

TEST_CASE("columns computed in a thread are bitwise equal to those computed in the tick", "[haptic][columns][M13]") {
  Sparse asynchronous = make_model(ColumnFill::asynchronous), synchronous = make_model(ColumnFill::synchronous);
  const int count = static_cast<int>(synchronous.contact_surface().vertex_count());
  REQUIRE(count > 100);
  REQUIRE(count <= 256);
  for (int first = 0; first < count; first += 8) {
    std::vector<int> some(static_cast<std::size_t>(std::min(8, count - first)));
    std::iota(some.begin(), some.end(), first);
    REQUIRE(!synchronous.require_columns(some).has(StatusFlag::degraded_model));
    bool complete = false;
    for (int i = 0; i < 20'000 && !complete; ++i) {
      complete = !asynchronous.require_columns(some).has(StatusFlag::degraded_model);
      if (!complete) std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
    REQUIRE(complete);
    for (const int i : some)
      for (const int j : some) REQUIRE(Matrix3(asynchronous.compliance(i, j)) == Matrix3(synchronous.compliance(i, j)));
  }
}

TEST_CASE("by default columns that would delay a tick are computed in a thread", "[haptic][columns]") {
  const auto asynchronous = []<class Policy>(Policy, std::array<int, 3> cells,
                                             ColumnFill fill = SetupOptions{}.columns) {
    SetupOptions options;
    options.columns = fill;
    const auto model = test::make_pad<HapticFEModel<Tet4, LinearElastic, Policy>>("surface", 1e4, cells, options);
    return model.report().asynchronous_columns;
  };
  using Stored = Condensed<SelectiveInverse>;
  const std::array small{2, 2, 2}, large{10, 10, 6};
  CHECK_FALSE(asynchronous(SparseCholesky(), small));
  CHECK(asynchronous(SparseCholesky(), large));
  CHECK(asynchronous(ConjugateGradient(), large));
  CHECK_FALSE(asynchronous(Condensed<DenseCholesky>(), small));
  CHECK(asynchronous(Condensed<DenseCholesky>(), large));
  CHECK_FALSE(asynchronous(Stored(), large));  // nothing is missing
  CHECK_FALSE(asynchronous(SparseCholesky(), large, ColumnFill::synchronous));
  CHECK(asynchronous(SparseCholesky(), small, ColumnFill::asynchronous));
}

TEST_CASE("by default a tick of a whole surface does not wait for its columns", "[haptic][columns]") {
  auto pad = test::make_pad<Sparse>("surface", 1e4, {10, 10, 6}, {});
  ServoSession session(pad);
  session.press(2e-3);
  REQUIRE(settle(session));
  auto reference_pad = test::make_pad<Sparse>("surface", 1e4, {10, 10, 6});
  ServoSession reference(reference_pad);
  reference.press(2e-3);
  reference.hold(50);
  const Vector3 f = session.servo.tick_view().contact_force(), g = reference.servo.tick_view().contact_force();
  CHECK((f - g).norm() <= 2e-2 * g.norm());  // on the way there, another number of points may have been chosen
}

TEST_CASE("a column that is not available yet is flagged, and the force stays finite and soft",
          "[haptic][columns][extreme]") {
  Sparse asynchronous = make_model(ColumnFill::asynchronous), synchronous = make_model(ColumnFill::synchronous);
  ServoSession session(asynchronous), reference(synchronous);
  const Vector3 above(0.0137, 0.0159, pad_height + sphere_radius + 5e-3),
      pressed(0.0137, 0.0159, pad_height + sphere_radius - 1.5e-3);
  session.tick(above);
  reference.tick(above);
  const bool flagged = session.tick(pressed).status.has(StatusFlag::degraded_model);
  reference.tick(pressed);
  const double f = session.servo.tick_view().contact_force().norm(),
               g = reference.servo.tick_view().contact_force().norm();
  CHECK(std::isfinite(f));
  CHECK(f <= 5.0 * g);
  if (!flagged) CHECK(std::abs(f - g) <= 1e-2 * g);  // the thread finished before the tick
}

TEST_CASE("with fewer slots than vertices near the sphere the force stays finite", "[haptic][columns][extreme]") {
  Sparse asynchronous = make_model(ColumnFill::asynchronous, 4);
  ServoSession session(asynchronous);
  session.press(2e-3);
  for (int i = 0; i < 300; ++i) {
    const GatedForce& f = session.tick(session.states[0].position + Vector3(2e-5, 1e-5, 0.0));
    CHECK(f.force().allFinite());
    std::this_thread::sleep_for(std::chrono::microseconds(100));
  }
}

TEST_CASE("a model may be destroyed while columns are being computed, and may be moved", "[haptic][columns]") {
  for (int round = 0; round < 10; ++round) {
    Sparse first = make_model(ColumnFill::asynchronous);
    std::vector<int> all(static_cast<std::size_t>(first.contact_surface().vertex_count()));
    std::iota(all.begin(), all.end(), 0);
    first.prefetch(all);
    Sparse moved = std::move(first);
    for (int i = 0; i < 3 * round; ++i) {
      moved.require_columns(all);
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
  SUCCEED();
}
