// Pieces that move: free flight, rest on tissue and on each other, cut off in the jaws of a tool, and refusals.
#include <palpate/contact/touching_tissues.hpp>
#include <palpate/core/rigid_motion.hpp>
#include <palpate/cut/cuttable.hpp>
#include <palpate/cut/moving_pieces.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/haptic/haptic_servo.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/mesh/where.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/testing/tissue_laws.hpp>

#include "refused.hpp"

#include "catch.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <vector>

using namespace palpate;

namespace moving_pieces_test {

namespace {

using Organ = HapticFEModel<Tet4, LinearElastic, Condensed<SelectiveInverse>>;
using CutOrgan = HapticFEModel<Tet4, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;

constexpr double gravity = 9.81, density = 1000.0, top = 20e-3;
const Vector3 piece_size(9e-3, 8e-3, 6e-3);
const LinearElastic material{.youngs_modulus = 5e3, .poisson_ratio = 0.4, .density = density};

Organ slab() {
  return {box_tet4({60e-3, 60e-3, top}, {12, 12, 4}), Scene().fix("z0").touch("z1"), material};
}

/// A block whose middle is there, rotated about it.
DetachedPiece block(const Vector3& middle, const Vector3& size = piece_size,
                    const Matrix3& rotation = Matrix3::Identity()) {
  DetachedPiece p;
  p.mass = density * size.prod();
  p.centre = middle;
  const Vector3 square = size.cwiseProduct(size);
  const Vector3 diagonal(square[1] + square[2], square[0] + square[2], square[0] + square[1]);
  p.inertia = rotation * Matrix3((p.mass / 12.0 * diagonal).asDiagonal()) * rotation.transpose();
  for (int i = 0; i < 8; ++i) {
    const Vector3 corner(i & 1, (i >> 1) & 1, (i >> 2) & 1);
    p.points.push_back(middle + rotation * (corner - Vector3::Constant(0.5)).cwiseProduct(size));
  }
  p.triangles = {{0, 2, 1}, {1, 2, 3}, {4, 5, 6}, {5, 7, 6}, {0, 1, 4}, {1, 5, 4},
                 {2, 6, 3}, {3, 6, 7}, {0, 4, 2}, {2, 4, 6}, {1, 3, 5}, {3, 7, 5}};
  return p;
}
Vector3 centre(const MovingPiece& piece) {
  return piece.pose * piece.shape->centre;
}
Vector3 centre(const MovingPieces& pieces, std::size_t k = 0) {
  return centre(pieces.pieces().at(k));
}

/// The part of the way at a tick.
double part(int tick, int begin, int end) {
  return std::clamp(static_cast<double>(tick - begin) / (end - begin), 0.0, 1.0);
}
/// A plate of 8 x 8 mm and 1 mm, with rounded edges of 1 mm.
ConvexTool plate() {
  std::vector<Vector3> corners;
  for (int i = 0; i < 8; ++i)
    corners.push_back(1e-3 * Vector3(i & 1 ? 4.0 : -4.0, i & 2 ? 4.0 : -4.0, i & 4 ? 0.5 : -0.5));
  return {corners, 1e-3};
}
void run(TouchingTissues& tissues, double seconds) {
  for (double time = 0.0; time < seconds;) time += tissues.background_work().next;
}
/// Sum of the forces of the others on a tissue.
Vector3 force_on(TouchingTissues& tissues, std::size_t k) {
  Vector3 sum = Vector3::Zero();
  for (const VertexForce& f : tissues.contact_forces(k)) sum += f.force.in_model_axes();
  return sum;
}

}  // namespace

TEST_CASE("pieces: free flight is a parabola", "[moving_pieces]") {
  MovingPieces pieces({.step = 1e-3});
  const Vector3 start(0.0, 0.0, 0.1), velocity(0.3, -0.2, 1.0);
  REQUIRE(pieces.add(block(start), velocity) == 0);
  pieces.background_work();  // the first one adds it
  const int steps = 200;
  for (int k = 0; k < steps; ++k) pieces.background_work();
  const double time = 1e-3 * steps;
  const Vector3 expected = start + time * velocity - 0.5 * gravity * time * time * Vector3::UnitZ();
  CHECK((centre(pieces) - expected).norm() < 1e-12);
}

TEST_CASE("pieces: a body that spins in free flight keeps its angular momentum and energy", "[moving_pieces]") {
  MovingPieces pieces({.step = 1e-3, .gravity = Vector3::Zero()});
  pieces.add(block(Vector3::Zero(), {20e-3, 10e-3, 4e-3}));
  pieces.background_work();
  // A pair of forces during one step.
  const std::array<VertexForce, 2> pair{VertexForce{0, ModelVector(0.01, 0.02, -0.03)},
                                        VertexForce{7, ModelVector(-0.01, -0.02, 0.03)}};
  const DetachedPiece shape = *pieces.pieces().front().shape;
  const Vector3 moment = (shape.points[0] - shape.points[7]).cross(Vector3(0.01, 0.02, -0.03));
  pieces.end_tick(pair);
  pieces.background_work();
  pieces.end_tick({});
  const Vector3 momentum = 1e-3 * moment;
  const auto spin = [&](const Matrix3& r) { return Vector3(r * shape.inertia.inverse() * r.transpose() * momentum); };
  Matrix3 before = pieces.pieces().front().pose.linear();
  double least = infinity, most = 0.0;
  for (int k = 0; k < 2000; ++k) {
    pieces.background_work();
    const Matrix3 now = pieces.pieces().front().pose.linear();
    const Vector3 rate = rotation_vector(now * before.transpose()) / 1e-3, middle = spin(now);
    CHECK((rate - middle).norm() < 0.02 * middle.norm());
    least = std::min(least, momentum.dot(middle));
    most = std::max(most, momentum.dot(middle));
    before = now;
  }
  CHECK(most < 1.05 * least);  // twice the energy
  CHECK(centre(pieces).norm() < 1e-12);
}

TEST_CASE("pieces: one falls 100 mm in the time of free fall and rests; the slab bears its weight", "[moving_pieces]") {
  Organ tissue = slab();
  MovingPieces pieces({.step = 1e-3});
  TouchingTissues touching(tissue, pieces);
  const double height = 0.1, tilt = GENERATE(0.0, 0.3);
  const Matrix3 rotation = rotation_by(tilt * Vector3(1.0, 0.5, 0.0).normalized());
  DetachedPiece given = block(Vector3::Zero(), piece_size, rotation);
  double lowest = 0.0;
  for (const Vector3& p : given.points) lowest = std::min(lowest, p[2]);
  const Vector3 start(30e-3, 30e-3, top + height - lowest);
  pieces.add(block(start, piece_size, rotation));
  double touched = 0.0, time = 0.0;
  while (touched == 0.0 && time < 0.3) {
    time += touching.background_work().next;
    if (touching.report().force > 0.0) touched = time;
  }
  CHECK(touched == Catch::Approx(std::sqrt(2.0 * height / gravity)).epsilon(0.01).margin(1e-3));
  run(touching, 0.8);
  const double weight = gravity * given.mass;
  CHECK(force_on(touching, 1)[2] == Catch::Approx(weight).epsilon(0.03));  // without friction
  CHECK((force_on(touching, 0) + force_on(touching, 1)).norm() < 1e-12 * weight);
  const Vector3 rests = centre(pieces);
  CHECK(pieces.pieces().front().velocity.norm() < 1e-3);
  CHECK(rests[2] == Catch::Approx(top + 0.5 * piece_size[2]).margin(0.2e-3));
  run(touching, 0.5);
  CHECK((centre(pieces) - rests).norm() < 2e-5);
  CHECK(touching.report().status.ok());
}

TEST_CASE("pieces: a thin one that falls a metre does not pass through a thin slab", "[moving_pieces]") {
  Organ tissue(box_tet4({60e-3, 60e-3, 6e-3}, {12, 12, 2}), Scene().fix("z0").touch("z1"), material);
  MovingPieces pieces;
  TouchingTissues touching(tissue, pieces);
  const double height = GENERATE(0.2, 0.5, 1.0);
  pieces.add(block({30e-3, 30e-3, 6e-3 + height}, {10e-3, 10e-3, 1.5e-3}));
  run(touching, 0.7);
  CHECK(centre(pieces)[2] > 5e-3);
  CHECK(centre(pieces)[2] < 9e-3);
  CHECK(force_on(touching, 1)[2] == Catch::Approx(gravity * density * 0.15e-6).epsilon(0.02));
}

TEST_CASE("pieces: friction holds one on a slope up to its angle", "[moving_pieces]") {
  Organ tissue(box_tet4({60e-3, 60e-3, top}, {12, 12, 4}), Scene().fix("z0").touch("z1"),
               LinearElastic{.youngs_modulus = 1e6, .poisson_ratio = 0.4, .density = density});
  const double slope = std::atan(0.2);
  const bool holds = GENERATE(true, false);
  MovingPieces pieces(
      {.gravity = gravity * Vector3(std::sin(slope), 0.0, -std::cos(slope)), .friction = holds ? 0.25 : 0.1});
  TouchingTissues touching(tissue, pieces);
  pieces.add(block({15e-3, 30e-3, top + 0.5 * piece_size[2] + 1e-5}));
  run(touching, 0.3);
  const double path = centre(pieces)[0] - 15e-3;
  const double acceleration = gravity * (std::sin(slope) - 0.1 * std::cos(slope));
  if (holds)
    CHECK(std::abs(path) < 0.1e-3);
  else
    CHECK(path == Catch::Approx(0.5 * acceleration * 0.3 * 0.3).epsilon(0.05));
}

TEST_CASE("pieces: three on top of each other rest, and the slab bears all of them", "[moving_pieces]") {
  Organ tissue = slab();
  MovingPieces pieces;
  TouchingTissues touching(tissue, pieces);
  for (int k = 0; k < 3; ++k) pieces.add(block({30e-3, 30e-3, top + (3.5 + 6.5 * k) * 1e-3}));
  run(touching, 0.5);
  const double weight = gravity * density * piece_size.prod();
  CHECK(force_on(touching, 0)[2] == Catch::Approx(-3.0 * weight).epsilon(0.01));
  CHECK(touching.report().force == Catch::Approx(6.0 * weight).epsilon(0.01));  // 3 + 2 + 1
  for (std::size_t k = 1; k < 3; ++k)
    CHECK(centre(pieces, k)[2] - centre(pieces, k - 1)[2] == Catch::Approx(piece_size[2]).epsilon(0.01));
}

TEST_CASE("pieces: one inside another is flagged", "[moving_pieces]") {
  Organ tissue = slab();
  MovingPieces pieces({.gravity = Vector3::Zero()});
  TouchingTissues touching(tissue, pieces);
  const Vector3 middle(30e-3, 30e-3, 60e-3);
  pieces.add(block(middle, Vector3::Constant(12e-3)));
  run(touching, 0.01);
  CHECK(touching.report().status.ok());
  pieces.add(block(middle, Vector3::Constant(3e-3)));
  for (int step = 0; step < 20; ++step) {
    run(touching, 2e-3);
    if (step > 1 && (centre(pieces, 1) - centre(pieces, 0)).norm() < 4e-3)
      CHECK(touching.report().status.has(StatusFlag::lost_contact));
  }
  CHECK((centre(pieces, 1) - centre(pieces, 0)).norm() < 4e-3);  // it does not get out
}

TEST_CASE("pieces: a tool presses one against the slab", "[moving_pieces]") {
  Organ tissue = slab();
  MovingPieces pieces;
  TouchingTissues touching(tissue, pieces);
  HapticServo servo(touching.group(), SphereTool{5e-3});
  pieces.add(block({30e-3, 30e-3, top + 0.5 * piece_size[2] + 1e-4}));
  run(touching, 0.2);
  Vector3 force = Vector3::Zero();
  double time = 0.0, next = 0.0;
  Status status;
  for (int tick = 0; tick < 600; ++tick) {
    time += 1e-3;
    const double height = top + piece_size[2] + 6e-3 - 2e-3 * std::min(1.0, tick / 300.0);
    const ToolState state{.position = {30e-3, 30e-3, height}, .time = time, .now = time};
    const GatedForce ticked = servo.tick(state);
    force = ticked.force();
    status = ticked.status;
    while (time >= next) next += touching.background_work().next;
  }
  const double weight = gravity * density * piece_size.prod();
  CHECK(force[2] > 0.02);
  CHECK(-force_on(touching, 0)[2] == Catch::Approx(force[2] + weight).epsilon(0.01));
  CHECK_FALSE(status.has(StatusFlag::coarse_contact));
}

TEST_CASE("pieces: light ones that a flat tool presses deep stay under it", "[moving_pieces]") {
  const double modulus = GENERATE(5e3, 1e9);
  Organ tissue(box_tet4({60e-3, 60e-3, top}, {12, 12, 4}), Scene().fix("z0").touch("z1"),
               LinearElastic{.youngs_modulus = modulus, .poisson_ratio = 0.4, .density = density});
  MovingPieces pieces;
  TouchingTissues touching(tissue, pieces);
  const double size = GENERATE(3e-3, 4e-3, 6e-3, 8e-3);
  pieces.add(block({30e-3, 30e-3, top + 0.5 * size}, Vector3::Constant(size)));
  ServoOptions options;
  options.contact.friction = 0.5;
  options.devices = {DeviceLimits{.stiffness = 500.0}};
  HapticServo servo(touching.group(), plate(), options);
  Vector3 force = Vector3::Zero();
  double next = 0.0;
  for (int tick = 0; tick < 700; ++tick) {
    const double time = 1e-3 * tick;
    ToolState state{.position = {30e-3, 30e-3, top + size + 1.5e-3 - 5e-3 * part(tick, 200, 600)}, .time = time};
    state.now = time;
    force = servo.tick(state).force();
    while (time >= next) next += touching.background_work().next;
  }
  if (modulus > 1e6) CHECK(force[2] == Catch::Approx(500.0 * 5e-3).epsilon(0.01));  // that of the coupling
  CHECK((centre(pieces) - Vector3(30e-3, 30e-3, top)).norm() < 5e-3);
  CHECK(pieces.pieces().front().velocity.norm() < 0.3);
}

namespace {

/// A bar along x, of which a blade between two jaws and the support cuts the free end off.
struct Bar {
  static constexpr double length = 40e-3, width = 12e-3, height = 8e-3;
  CutOrgan tissue{box_tet4({length, width, height}, {10, 3, 2}), Scene().fix("x0").touch("surface"),
                  LinearElastic{.youngs_modulus = 10e3, .poisson_ratio = 0.4, .density = density}};
  double cut_at = 14e-3;
  BladeSweep sweep(double from, double to) const {
    const double in = -5e-3, out = width + 5e-3;
    return {{cut_at, in, from}, {cut_at, out, from}, {cut_at, in, to}, {cut_at, out, to}};
  }
  /// Middles of the jaws around the free end, at an opening between them, lifted and moved along x.
  static std::array<Vector3, 2> jaws(double opening, double lift, double along) {
    const Vector3 middle(length - 8e-3 + along, 0.5 * width, 0.5 * height + lift);
    const Vector3 half(0.0, 0.0, 0.5 * opening + 1.5e-3);
    return {middle + half, middle - half};
  }
};

ServoOptions gripping() {
  ServoOptions options;
  options.contact.friction = 0.5;
  options.devices = {DeviceLimits{.stiffness = 500.0}, DeviceLimits{.stiffness = 500.0}};
  return options;
}

}  // namespace

TEST_CASE("pieces: jaws keep their grip while the tissue between them is cut", "[moving_pieces]") {
  Bar bar;
  HapticServo servo(bar.tissue, {plate(), plate()}, gripping());
  double before = 0.0;
  for (int tick = 0; tick < 500; ++tick) {
    const auto places = Bar::jaws(10e-3 - 4e-3 * part(tick, 0, 100), 4e-3 * part(tick, 100, 300), 0.0);
    std::array<ToolState, 2> states;
    for (std::size_t k = 0; k < 2; ++k) states[k] = {.position = places[k], .time = 1e-3 * tick, .now = 1e-3 * tick};
    if (tick == 350) bar.tissue.cut(bar.sweep(Bar::height + 1e-3, 0.5 * Bar::height + 1e-3));  // half of the section
    const auto forces = servo.tick(states);
    while (bar.tissue.process_cuts()) continue;
    if (tick == 340) before = forces[0].force()[2];
    if (tick <= 340) continue;
    CHECK(forces[0].force()[2] > 0.8 * before);
    CHECK(forces[1].force()[2] < -0.8 * before);
  }
  CHECK(before > 0.05);
  CHECK(bar.tissue.cut_report().cuts > 0);
}

TEST_CASE("pieces: one that is cut off stays in the jaws, is carried, and falls when they open", "[moving_pieces]") {
  Bar bar;
  Organ tissue(box_tet4({120e-3, 60e-3, 15e-3}, {12, 6, 2}), Scene().fix("z0").touch("z1"), material);
  tissue.set_pose(Eigen::Isometry3d(Eigen::Translation3d(-20e-3, -24e-3, -60e-3)));
  MovingPieces pieces;
  pieces.take_from(bar.tissue);
  TouchingTissues touching(tissue, bar.tissue, pieces);
  HapticServo servo(touching.group(), {plate(), plate()}, gripping());
  double next = 0.0, lifted = 0.0, weight = 0.0, carried = 0.0, borne = 0.0;
  for (int tick = 0; tick < 2000; ++tick) {
    const double time = 1e-3 * tick;
    const double opening = 10e-3 - 4e-3 * part(tick, 0, 100) + 8e-3 * part(tick, 900, 950);
    const auto places = Bar::jaws(opening, 3e-3 * part(tick, 100, 300), 30e-3 * part(tick, 500, 800));
    std::array<ToolState, 2> states;
    for (std::size_t k = 0; k < 2; ++k) states[k] = {.position = places[k], .time = time, .now = time};
    if (tick == 350) bar.tissue.cut(bar.sweep(Bar::height + 10e-3, -10e-3));
    const auto forces = servo.tick(states);
    while (time >= next) next += touching.background_work().next;
    if (tick == 480) lifted = centre(pieces)[0];
    if (tick == 850) weight = -(forces[0].force() + forces[1].force())[2];
    if (tick == 850) carried = centre(pieces)[0];
    if (tick > 1900) borne = std::max(borne, -force_on(touching, 0)[2]);
  }
  REQUIRE(pieces.pieces().size() == 1);
  const MovingPiece piece = pieces.pieces().front();
  CHECK(piece.shape->mass ==
        Catch::Approx(density * Bar::width * Bar::height * (Bar::length - bar.cut_at)).epsilon(0.15));
  CHECK(weight == Catch::Approx(gravity * piece.shape->mass).epsilon(0.05));
  CHECK(carried - lifted == Catch::Approx(30e-3).epsilon(0.03));
  CHECK(centre(piece)[2] < -25e-3);
  CHECK(borne == Catch::Approx(gravity * piece.shape->mass).epsilon(0.1));
  CHECK(detached_pieces(bar.tissue).empty());  // the tissue does not have it any more
  Vector3 open = Vector3::Zero();
  double volume = 0.0;
  for (const auto& [a, b, c] : piece.shape->triangles) {
    const auto at = [&](int v) { return piece.shape->points[static_cast<std::size_t>(v)] - piece.shape->centre; };
    open += (at(b) - at(a)).cross(at(c) - at(a));
    volume += at(a).dot(at(b).cross(at(c))) / 6.0;
  }
  CHECK(open.norm() < 1e-12);  // a closed surface
  CHECK(density * volume == Catch::Approx(piece.shape->mass).epsilon(0.05));
}

TEST_CASE("pieces: a tool that grasps keeps the part that is cut off", "[moving_pieces]") {
  Bar bar;
  Organ tissue(box_tet4({20e-3, 20e-3, 5e-3}, {2, 2, 1}), Scene().fix("z0").touch("z1"), material);
  tissue.set_pose(Eigen::Isometry3d(Eigen::Translation3d(0.0, 0.0, -0.5)));
  MovingPieces pieces;
  pieces.take_from(bar.tissue);
  TouchingTissues touching(tissue, bar.tissue, pieces);
  ServoOptions options;
  options.grasp_buttons = 1;
  options.contact.grasp_radius = 3e-3;
  HapticServo servo(touching.group(), SphereTool{3e-3}, options);
  double next = 0.0;
  Vector3 force = Vector3::Zero();
  for (int tick = 0; tick < 1200; ++tick) {
    const double time = 1e-3 * tick;
    ToolState state{.position = Vector3(Bar::length - 10e-3, 0.5 * Bar::width, Bar::height + 2.8e-3), .time = time};
    state.now = time;
    state.position[2] += 3e-3 * part(tick, 200, 400);
    state.position[0] += 20e-3 * part(tick, 600, 1000);
    state.buttons = tick > 100 ? 1u : 0u;
    if (tick == 450) bar.tissue.cut(bar.sweep(Bar::height + 10e-3, -10e-3));
    force = servo.tick(state).force();
    while (time >= next) next += touching.background_work().next;
  }
  REQUIRE(pieces.pieces().size() == 1);
  const MovingPiece piece = pieces.pieces().front();
  CHECK(-force[2] == Catch::Approx(gravity * piece.shape->mass).epsilon(0.05));
  CHECK(centre(piece)[0] - piece.shape->centre[0] == Catch::Approx(20e-3).epsilon(0.05));
}

TEST_CASE("pieces: one that is removed is gone, vertices keep their numbers, and clear begins again",
          "[moving_pieces]") {
  Organ tissue = slab();
  MovingPieces pieces;
  TouchingTissues touching(tissue, pieces);
  pieces.add(block({20e-3, 30e-3, top + 4e-3}));
  pieces.add(block({40e-3, 30e-3, top + 4e-3}));
  run(touching, 0.2);
  const double weight = gravity * density * piece_size.prod();
  CHECK(-force_on(touching, 0)[2] == Catch::Approx(2.0 * weight).epsilon(0.01));
  pieces.remove(0);
  run(touching, 0.1);
  REQUIRE(pieces.pieces().size() == 1);
  CHECK(pieces.pieces().front().id == 1);
  CHECK(-force_on(touching, 0)[2] == Catch::Approx(weight).epsilon(0.01));
  CHECK(pieces.newest_surface().vertex_count() == 16);
  CHECK(test::refusal_kind([&] { pieces.remove(0); }) == "index_out_of_range");
  pieces.clear();
  touching.reset();
  run(touching, 0.1);
  CHECK(pieces.pieces().empty());
  CHECK(touching.report().force == 0.0);
}

TEST_CASE("pieces satisfy the laws of a tissue", "[moving_pieces]") {
  MovingPieces pieces;
  pieces.add(block({0.0, 0.0, 1.0}, piece_size, rotation_by({0.3, -0.2, 0.5})));
  pieces.add(block({0.1, 0.0, 1.0}, 0.1 * piece_size));
  pieces.background_work();
  pieces.begin_tick();
  std::vector<int> vertices(static_cast<std::size_t>(pieces.contact_surface().vertex_count()));
  std::iota(vertices.begin(), vertices.end(), 0);
  CHECK(vertices.size() == 16);
  CHECK(testing::describe(testing::tissue_laws(pieces, vertices)) == "");
}

TEST_CASE("pieces: what makes no sense is refused", "[moving_pieces]") {
  CHECK(test::refusal_kind([] { MovingPieces pieces({.step = 0.0}); }) == "bad_argument");
  CHECK(test::refusal_kind([] { MovingPieces pieces({.gravity = {0.0, infinity, 0.0}}); }) == "bad_argument");
  CHECK(test::refusal_kind([] { MovingPieces pieces({.friction = -0.1}); }) == "bad_argument");
  MovingPieces pieces;
  DetachedPiece given = block(Vector3::Zero());
  given.mass = 0.0;
  CHECK(test::refusal_kind([&] { pieces.add(given); }) == "bad_density");
  given = block(Vector3::Zero());
  given.triangles.clear();
  CHECK(test::refusal_kind([&] { pieces.add(given); }) == "bad_argument");
  given = block(Vector3::Zero());
  given.triangles[0][0] = 8;
  CHECK(test::refusal_kind([&] { pieces.add(given); }) == "index_out_of_range");
  CHECK(test::refusal_kind([&] { pieces.remove(0); }) == "index_out_of_range");
  CutOrgan light(box_tet4({10e-3, 10e-3, 10e-3}, {2, 2, 2}), Scene().fix("z0").touch("z1"),
                 LinearElastic{.youngs_modulus = 5e3, .poisson_ratio = 0.4});
  CHECK(test::refusal_kind([&] { pieces.take_from(light); }) == "bad_density");
  Bar bar;
  pieces.take_from(bar.tissue);
  CHECK(test::refusal_kind([&] { TouchingTissues touching(pieces, bar.tissue); }) == "bad_argument");
  CHECK(test::refusal_kind([&] { TouchingTissues touching(bar.tissue, pieces); }) == "accepted");
}

}  // namespace moving_pieces_test
