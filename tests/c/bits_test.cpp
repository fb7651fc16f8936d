// Forces, errors and surfaces of the C interface are those of the C++ composition, to the last bit, and its ticks
// allocate nothing.
#include <catch.hpp>

#include <palpate/c/palpate.h>
#include <palpate/core/platform.hpp>
#include <palpate/model/rendering/visual_surface.hpp>
#include <palpate/model/static/measured_force_error.hpp>
#include <palpate/palpate.hpp>
#include <palpate/testing/allocation_counter.hpp>

#include "box.h"

#include <cstring>
#include <memory>
#include <vector>

namespace {

using namespace palpate;

/// A press, a slide and a leap, of one or two tools.
std::vector<ToolState> states_of(int tools) {
  std::vector<ToolState> states;
  for (int tick = 0; tick < 400; ++tick)
    for (int tool = 0; tool < tools; ++tool) {
      ToolState s;
      const double depth = tick < 100 ? 1e-2 - 1.2e-4 * tick : -2e-3;
      s.position = Vector3(1e-3 + 2e-2 * tool + (tick > 200 ? 3e-5 * (tick - 200) : 0.0), -2e-3, 0.044 + depth);
      if (tick == 350) s.position[0] -= 0.03;
      const double angle = 1e-3 * tick;
      s.orientation = {std::cos(angle), 0.0, std::sin(angle), 0.0};
      s.time = s.now = 1e-3 * tick;
      states.push_back(s);
    }
  return states;
}

std::vector<palpate_tool_state> as_c(const std::vector<ToolState>& states) {
  std::vector<palpate_tool_state> all(states.size());
  for (std::size_t i = 0; i < states.size(); ++i) {
    PALPATE_INIT(&all[i]);
    std::copy_n(states[i].position.data(), 3, all[i].position);
    std::copy_n(states[i].orientation.data(), 4, all[i].orientation);
    all[i].time = states[i].time;
    all[i].now = states[i].now;
    all[i].given = PALPATE_HAS_ORIENTATION | PALPATE_HAS_NOW;
  }
  return all;
}

bool are_same(const Vector3& a, const double (&b)[3]) {
  return std::memcmp(a.data(), b, sizeof b) == 0;
}

struct Box {
  Box() { make_box(&shape); }
  box shape{};
};

palpate_session* c_session(const box& b, const char* policy, bool two) {
  palpate_mesh* mesh = nullptr;
  palpate_scene* scene = nullptr;
  palpate_tissue* tissue = nullptr;
  palpate_session* session = nullptr;
  REQUIRE(palpate_mesh_from_arrays(b.positions, BOX_NODES, b.cells, BOX_CELLS, 4, nullptr, &mesh) == PALPATE_OK);
  REQUIRE(palpate_mesh_add_group(mesh, "bottom", b.bottom, b.side) == PALPATE_OK);
  REQUIRE(palpate_mesh_add_group(mesh, "top", b.top, b.side) == PALPATE_OK);
  REQUIRE(palpate_scene_create(&scene) == PALPATE_OK);
  REQUIRE(palpate_scene_fix(scene, "bottom") == PALPATE_OK);
  REQUIRE(palpate_scene_touch(scene, "top", 6e-3) == PALPATE_OK);
  const double gravity[3] = {0.0, 0.0, -9.81};
  REQUIRE(palpate_scene_gravity(scene, gravity) == PALPATE_OK);
  palpate_material material;
  PALPATE_INIT(&material);
  material.youngs_modulus = 5e3;
  material.poisson_ratio = 0.45;
  material.density = 1060.0;
  palpate_setup setup;
  PALPATE_INIT(&setup);
  setup.policy = policy;
  setup.materials = &material;
  setup.material_count = 1;
  setup.force_error_places = 1;
  setup.columns = PALPATE_COLUMNS_SYNCHRONOUS;
  REQUIRE(palpate_tissue_create(mesh, scene, &setup, &tissue) == PALPATE_OK);
  palpate_tool tools[2];
  PALPATE_INIT(&tools[0]);
  PALPATE_INIT(&tools[1]);
  tools[0].radius = 6e-3;
  tools[1].kind = PALPATE_CAPSULE;
  tools[1].radius = 6e-3;
  tools[1].half_length = 5e-3;
  tools[1].axis[0] = 1.0;
  palpate_session_options options;
  PALPATE_INIT(&options);
  options.friction = 0.3;
  REQUIRE(palpate_session_create(tissue, tools, two ? 2 : 1, &options, &session) == PALPATE_OK);
  palpate_tissue_destroy(tissue);
  palpate_scene_destroy(scene);
  palpate_mesh_destroy(mesh);
  return session;
}

template <class Model>
void compare(const char* policy, bool two) {
  CAPTURE(policy, two);
  const auto b = std::make_unique<Box>();
  const box& shape = b->shape;
  Mesh<Tet4> mesh;
  for (int i = 0; i < BOX_NODES; ++i) mesh.positions.emplace_back(shape.positions + 3 * i);
  for (int e = 0; e < BOX_CELLS; ++e)
    mesh.elements.push_back(
        {shape.cells[4 * e], shape.cells[4 * e + 1], shape.cells[4 * e + 2], shape.cells[4 * e + 3]});
  mesh.groups.get_or_add("bottom", 0).nodes.assign(shape.bottom, shape.bottom + shape.side);
  mesh.groups.get_or_add("top", 0).nodes.assign(shape.top, shape.top + shape.side);
  Scene scene;
  scene.fix("bottom").touch("top", {.radius = 6e-3}).gravity({0.0, 0.0, -9.81});
  SetupOptions options;
  options.force_error = measured_force_error(1);
  options.columns = ColumnFill::synchronous;
  Model model(mesh, scene, {.youngs_modulus = 5e3, .poisson_ratio = 0.45, .density = 1060.0}, options);
  std::vector<Tool> tools{SphereTool{6e-3}};
  if (two) tools.emplace_back(CapsuleTool(6e-3, 5e-3, {1.0, 0.0, 0.0}));
  ServoOptions servo_options;
  servo_options.contact.friction = 0.3;
  HapticServo servo(model, ToolList(tools), servo_options);
  VisualSurface<Model> skin(model);

  palpate_session* session = c_session(shape, policy, two);
  const std::vector<ToolState> states = states_of(static_cast<int>(tools.size()));
  const std::vector<palpate_tool_state> given = as_c(states);
  std::vector<palpate_tool_force> forces(states.size());
  for (palpate_tool_force& f : forces) PALPATE_INIT(&f);

  // One tick alone, then all others in one call.
  const std::uint64_t before = testing::detail::heap_calls_now().allocations;
  REQUIRE(palpate_session_tick(session, given.data(), 1, forces.data()) == PALPATE_OK);
  REQUIRE(palpate_session_tick(session, given.data() + tools.size(), states.size() / tools.size() - 1,
                               forces.data() + tools.size()) == PALPATE_OK);
  CHECK(testing::detail::heap_calls_now().allocations == before);

  const FlushDenormals flush;
  int pressed = 0;
  for (std::size_t tick = 0; tick < states.size(); tick += tools.size()) {
    const auto expected = servo.tick({states.data() + tick, tools.size()});
    for (std::size_t i = 0; i < tools.size(); ++i) {
      const palpate_tool_force& f = forces[tick + i];
      CAPTURE(tick, i);
      REQUIRE(are_same(expected[i].force(), f.force));
      REQUIRE(are_same(servo.tick_view().contact_force(i), f.contact_force));
      REQUIRE(expected[i].status.bits() == f.status);
      REQUIRE(expected[i].error.expected == f.error_expected);
      REQUIRE(expected[i].error.bound == f.error_bound);
      REQUIRE(servo.tick_view().contact_rows() == f.contacts);
      if (servo.tick_view().contact_force(i).norm() > 1e-3) ++pressed;
    }
  }
  CHECK(pressed > 100);

  std::size_t points = 0, triangles = 0;
  REQUIRE(palpate_session_surface_size(session, &points, &triangles) == PALPATE_OK);
  REQUIRE(points == static_cast<std::size_t>(skin.point_count()));
  REQUIRE(triangles == skin.triangles().size());
  std::vector<float> x(3 * points), n(x), expected_x(x), expected_n(x);
  const std::uint64_t before_reading = testing::detail::heap_calls_now().allocations;
  REQUIRE(palpate_session_read_surface(session, x.data(), n.data(), x.size()) == PALPATE_OK);
  CHECK(testing::detail::heap_calls_now().allocations == before_reading);
  REQUIRE(skin.read_surface(servo.read_snapshot(), expected_x, expected_n));
  CHECK(x == expected_x);
  CHECK(n == expected_n);
  palpate_session_destroy(session);
}

}  // namespace

TEST_CASE("forces of the C interface are bitwise those of the C++ composition", "[c]") {
  using Element = Smoothed<Tet4>;
  for (const bool two : {false, true}) {
    compare<HapticFEModel<Element, LinearElastic, Condensed<SelectiveInverse>>>("smoothed_tet4/linear/condensed", two);
    compare<HapticFEModel<Element, LinearElastic, Condensed<SelectiveInverseFloat>>>(
        "smoothed_tet4/linear/condensed_float", two);
    compare<HapticFEModel<Tet4, LinearElastic, SelectiveInverse>>("tet4/linear/inverse", two);
    compare<HapticFEModel<Tet4, LinearElastic, SparseCholesky>>("tet4/linear/sparse_cholesky", two);
  }
}
