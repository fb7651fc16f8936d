// The parts of the error bar of a force that do not come from the mesh, each against a truth.
#include <palpate/element/wrappers.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/material/neo_hookean.hpp>
#include <palpate/mesh/generators_box.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/moving/implicit.hpp>
#include <palpate/model/moving/quasi_newton.hpp>
#include <palpate/model/static/measured_force_error.hpp>

#include "catch.hpp"

#include <chrono>
#include <cmath>
#include <thread>

using namespace palpate;

namespace {

constexpr double parts_radius = 0.01;

struct PartsPress {
  double force = 0.0;
  ForceError error;
  Status status;
};

/// A block or plate; `thickness` in radii.
struct PartsBody {
  double thickness = 4.0, poisson_ratio = 0.45;
  bool plate = false;  ///< fixed at two sides instead of the bottom
  int cells = 8;
  double at = 0.5;  ///< of the sides, where it is pressed

  Vector3 size() const { return {6.0 * parts_radius, 6.0 * parts_radius, thickness * parts_radius}; }
  Mesh<Smoothed<Tet4>> mesh() const {
    const int layers = std::max(3, static_cast<int>(std::lround(cells * thickness / 6.0)));
    return copy_mesh<Smoothed<Tet4>>(box_tet4(size(), {cells, cells, layers}, BoxSplit::six));
  }
  Scene scene() const {
    Scene scene;
    if (plate)
      scene.fix("x0").fix("x1");
    else
      scene.fix("z0");
    return scene.touch("z1", {.radius = parts_radius});
  }
  LinearElastic material() const { return {5e3, poisson_ratio, 1000.0}; }
};

ServoOptions rigid_parts(int capacity) {
  ServoOptions options;
  options.coupling_stiffness = infinity;
  options.force_limits = ForceLimits{.peak_force = 1e6, .slew_rate = 1e9};
  options.contact.capacity = capacity;
  return options;
}

/// Presses to depths [radii] one after the other; a moving model rests at each of them.
template <class Model>
std::vector<PartsPress> press_to(Model& model, const PartsBody& body, const std::vector<double>& depths,
                                 int capacity = 300) {
  HapticServo servo(model, SphereTool{parts_radius}, rigid_parts(capacity));
  ToolState state;
  std::vector<PartsPress> presses;
  double from = -0.02;
  for (const double goal : depths) {
    double before = 0.0;
    for (int k = 1; k <= 80; ++k) {
      if constexpr (HasBackgroundWork<Model>) model.background_work();
      const double depth = parts_radius * (from + (goal - from) * std::min(1.0, k / 20.0));
      state.time += 1e-3;
      state.position = {body.at * body.size()[0], body.at * body.size()[1], body.size()[2] + parts_radius - depth};
      const Status status = servo.tick(state).status;
      const double force = servo.tick_view().contact_force()[2];
      if (k == 80 || (k > 30 && std::abs(force - before) < 1e-6 * force)) {
        presses.push_back({force, servo.tick_view().force_error(), status});
        break;
      }
      before = force;
    }
    from = goal;
  }
  return presses;
}

template <class Solver>
HapticFEModel<Smoothed<Tet4>, LinearElastic, Solver> parts_model(const PartsBody& body, SetupOptions options = {}) {
  options.force_error = measured_force_error(1);
  return {body.mesh(), body.scene(), body.material(), options};
}

}  // namespace

TEST_CASE("the force of a compliance stored as float differs by less than its part of the bound",
          "[force_error][parts]") {
  for (const bool plate : {false, true}) {
    const PartsBody body{.thickness = plate ? 1.0 : 4.0, .plate = plate};
    auto exact = parts_model<Condensed<SelectiveInverse>>(body);
    auto rounded = parts_model<Condensed<SelectiveInverseFloat>>(body);
    const auto truth = press_to(exact, body, {0.125, 0.5}), press = press_to(rounded, body, {0.125, 0.5});
    for (std::size_t i = 0; i < truth.size(); ++i) {
      CAPTURE(plate, i, truth[i].force, press[i].force, press[i].error.parts.storage);
      CHECK(truth[i].error.parts.storage == 0.0);
      CHECK(press[i].force != truth[i].force);
      CHECK(std::abs(press[i].force - truth[i].force) <= press[i].error.parts.storage + 2e-6 * truth[i].force);
      CHECK(press[i].error.parts.storage < 1e-4 * press[i].force);
    }
  }
}

TEST_CASE("the force of an iterative solver differs from that of a direct one by less than the part of the solver",
          "[force_error][parts]") {
  const PartsBody body{.poisson_ratio = 0.4999, .cells = 6};
  auto direct = parts_model<SparseCholesky>(body, {.columns = ColumnFill::synchronous});
  auto iterative = parts_model<ConjugateGradient>(body, {.columns = ColumnFill::synchronous});
  const auto truth = press_to(direct, body, {0.125, 0.5}), press = press_to(iterative, body, {0.125, 0.5});
  for (std::size_t i = 0; i < truth.size(); ++i) {
    const double allowed = press[i].error.parts.conditioning + truth[i].error.parts.conditioning;
    CAPTURE(i, truth[i].force, press[i].force, allowed);
    CHECK(truth[i].error.parts.conditioning > 0.0);
    CHECK(press[i].error.parts.conditioning > 0.0);
    CHECK(std::abs(press[i].force - truth[i].force) <= allowed + 2e-6 * truth[i].force);
    CHECK(allowed < 0.01 * truth[i].force);
  }
}

TEST_CASE("linear and Neo-Hookean forces differ by less than the part for large strain, which is flagged",
          "[force_error][parts]") {
  struct Row {
    PartsBody body;
    std::vector<double> depths;
  };
  int flagged = 0, fine = 0;
  for (const Row& row : {Row{{.thickness = 4.0, .poisson_ratio = 0.49}, {0.125, 0.5}},
                         Row{{.thickness = 2.0, .poisson_ratio = 0.3}, {0.25}},
                         Row{{.thickness = 1.0, .poisson_ratio = 0.45}, {0.125, 0.375}},
                         Row{{.thickness = 1.0, .poisson_ratio = 0.49, .plate = true}, {0.125, 0.75}}}) {
    auto linear = parts_model<Condensed<SelectiveInverse>>(row.body);
    HapticFEModel<Smoothed<Tet4>, NeoHookean, Implicit<QuasiNewton<>>> exact(
        row.body.mesh(), row.body.scene(), NeoHookean{5e3, row.body.poisson_ratio, 1000.0}, {},
        {.step = 0.016, .inertia = false, .maximum_iterations = 100, .tolerance = 1e-6});
    HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>> unmeasured(
        row.body.mesh(), row.body.scene(), row.body.material());
    const auto truth = press_to(exact, row.body, row.depths), press = press_to(linear, row.body, row.depths),
               without = press_to(unmeasured, row.body, row.depths);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double error = std::abs(press[i].force - truth[i].force), bound = press[i].error.parts.linearity;
      CAPTURE(row.body.thickness, row.body.poisson_ratio, row.depths[i], truth[i].force, press[i].force, bound);
      CHECK(error <= bound);
      CHECK(bound < 6.0 * error + 0.04 * press[i].force);
      const bool flag = press[i].status.has(StatusFlag::large_displacement);
      CHECK(flag == (bound > 0.1 * press[i].force));
      if (error > 0.1 * press[i].force) CHECK(flag);
      if (flag || bound < 0.08 * press[i].force)  // its expected error is unknown, so the strain may differ a little
        CHECK(without[i].status.has(StatusFlag::large_displacement) == flag);
      CHECK(std::isinf(without[i].error.bound));
      flagged += flag;
      fine += !flag;
      CHECK(std::isinf(truth[i].error.bound));  // nothing is measured for a model that moves
    }
  }
  CHECK(flagged >= 2);
  CHECK(fine >= 2);
}

TEST_CASE("a deep press over a fixed edge has a finite bound for large strain, and is flagged",
          "[force_error][parts]") {
  const PartsBody body{.thickness = 2.0, .plate = true, .at = 0.05};
  HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>> model(body.mesh(), body.scene(),
                                                                                  body.material());
  for (const PartsPress& press : press_to(model, body, {0.25, 0.5})) {
    CAPTURE(press.force, press.error.parts.linearity);
    CHECK(press.error.parts.linearity < infinity);
    CHECK(press.status.has(StatusFlag::large_displacement));
  }
}

TEST_CASE("a force with fewer rows than contacts differs by less than the part for merged contacts",
          "[force_error][parts]") {
  const PartsBody body{.cells = 24};
  auto model = parts_model<SparseCholesky>(body);
  const auto truth = press_to(model, body, {0.25, 0.5});
  double most = 0.0;
  for (const int capacity : {8, 12, 20}) {
    const auto press = press_to(model, body, {0.25, 0.5}, capacity);
    for (std::size_t i = 0; i < truth.size(); ++i) {
      const double error = std::abs(press[i].force - truth[i].force), bound = press[i].error.parts.merged;
      CAPTURE(capacity, i, truth[i].force, press[i].force, bound);
      CHECK(truth[i].error.parts.merged < 0.03 * truth[i].force);
      CHECK(error <= bound + truth[i].error.parts.merged);
      most = std::max(most, error / truth[i].force);
    }
  }
  CHECK(most > 0.01);
}

TEST_CASE("a press beyond small strain is flagged also where columns or rows are missing",
          "[force_error][parts][extreme]") {
  const PartsBody body{.cells = 12};
  const auto presses = [&](auto&& model, int capacity) {
    return press_to(model, body, {0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7}, capacity);
  };
  SetupOptions few;
  few.compliance_slots = 6;
  few.columns = ColumnFill::synchronous;
  using All = HapticFEModel<Smoothed<Tet4>, LinearElastic, Condensed<SelectiveInverse>>;
  using Few = HapticFEModel<Smoothed<Tet4>, LinearElastic, SparseCholesky>;
  const auto exact = presses(All(body.mesh(), body.scene(), body.material()), 300);
  const auto columns = presses(Few(body.mesh(), body.scene(), body.material(), few), 300);
  const auto rows = presses(All(body.mesh(), body.scene(), body.material()), 4);
  int large = 0, degraded = 0;
  for (std::size_t i = 0; i < exact.size(); ++i) {
    INFO("press " << i);
    large += exact[i].status.has(StatusFlag::large_displacement);
    for (const auto* press : {&columns[i], &rows[i]}) {
      degraded += press->status.has(StatusFlag::degraded_model);
      if (exact[i].status.has(StatusFlag::large_displacement))
        CHECK((press->status.has(StatusFlag::large_displacement) || press->status.has(StatusFlag::degraded_model)));
      if (i > 4) CHECK(press->status.has(StatusFlag::large_displacement));
    }
  }
  CHECK(large > 2);
  CHECK(degraded > 6);
}

TEST_CASE("the bound is infinite while a column is missing, then the force is that of a model with all columns",
          "[force_error][parts]") {
  const PartsBody body{.cells = 12, .at = 0.25};  // measured in the middle
  auto complete = parts_model<SparseCholesky>(body, {.columns = ColumnFill::synchronous});
  auto late = parts_model<SparseCholesky>(body, {.columns = ColumnFill::asynchronous});
  const double truth = press_to(complete, body, {0.25}).front().force;
  HapticServo servo(late, SphereTool{parts_radius}, rigid_parts(300));
  ToolState state;
  state.position = {body.at * body.size()[0] + 0.005, body.at * body.size()[1], body.size()[2] + 1.1 * parts_radius};
  servo.tick(state);
  state.position = {body.at * body.size()[0], body.at * body.size()[1], body.size()[2] + 0.75 * parts_radius};
  int missing = 0, there = 0;
  for (int k = 0; k < 5000 && there < 30; ++k) {
    state.time += 1e-3;
    const bool degraded = servo.tick(state).status.has(StatusFlag::degraded_model);
    if (servo.tick_view().contact_force()[2] == 0.0) continue;
    CHECK(degraded == std::isinf(servo.tick_view().force_error().parts.late));
    CHECK(std::isfinite(servo.tick_view().force_error().bound) == !degraded);
    missing += degraded;
    there = degraded ? 0 : there + 1;
    if (degraded) std::this_thread::sleep_for(std::chrono::microseconds(200));
  }
  CHECK(missing > 0);
  REQUIRE(there == 30);
  CHECK(servo.tick_view().contact_force()[2] == Catch::Approx(truth).epsilon(1.5e-2));  // with points of another level
}

TEST_CASE("the bound of a force is the sum of its parts", "[force_error][parts]") {
  const PartsBody body;
  auto model = parts_model<Condensed<SelectiveInverseFloat>>(body);
  const PartsPress press = press_to(model, body, {0.25}, 10).front();
  const ForceErrorParts& parts = press.error.parts;
  CHECK(press.error.force == Catch::Approx(press.force).epsilon(1e-3));
  for (const double part : {parts.mesh, parts.storage, parts.conditioning, parts.linearity}) CHECK(part > 0.0);
  CHECK(press.error.bound == parts.mesh + parts.storage + parts.conditioning + parts.linearity + parts.merged);
  CHECK(parts.late == 0.0);
}
