// Displacement of the surface under loads on points, and that of pads which tools grasp.
#include <palpate/contact/detail/surface_displacement.hpp>

#include "contact/servo_session.hpp"

#include "catch.hpp"

using namespace palpate;

TEST_CASE("a change of the compliance of the tissue keeps what the mesh shows of the loads", "[contact][half_space]") {
  test::Pad pad = test::make_pad();
  const TissueView tissue(pad);
  const ContactSurface& surface = pad.contact_surface();
  const SubfacetCompliance& subfacet = *surface.subfacet();
  const detail::ContactSamples samples(surface, 5e-4, 2e-3);
  detail::SurfaceDisplacement displacement(surface.vertex_count(), 8);
  const int number = samples.of_vertex(surface, 20);
  REQUIRE(number >= 0);
  const detail::ContactSample& sample = samples[number];
  const detail::HalfSpacePoint point = subfacet.point(sample, samples.normal(number));
  REQUIRE(point.is_known());
  const Vector3 force(0.0, 0.0, -0.1);
  int slot = -1;
  displacement.begin_tick(1);
  displacement.clear();
  displacement.add(20, force, slot);
  displacement.add_load({number, point, 1e-6, Vector3::Zero(), force}, sample);
  const Vector3 before = displacement.at_point(tissue, subfacet, sample, point, number);
  const Vector3 mesh = displacement.at(tissue, 20);
  CHECK(before[2] < 1.2 * mesh[2]);  // deeper than the mesh shows
  displacement.begin_tick(2);
  CHECK(displacement.at_point(tissue, subfacet, sample, point, number) == before);
}

TEST_CASE("a tool that is larger than another one has its own level from its first approach on", "[contact][levels]") {
  test::Pad pad = test::make_pad();
  HapticServo servo(pad, std::vector<SphereTool>{{.radius = 0.5e-3}, {.radius = 8e-3}});
  std::vector<ToolState> states(2);
  states[0].position = Vector3(0.1, 0.1, 0.1);
  for (double height = 0.012; height > 0.0065; height -= 1e-4) {
    for (ToolState& s : states) s.time += 1e-3;
    states[1].position = Vector3(0.015, 0.015, test::pad_height + height);
    CHECK_FALSE(servo.tick(states)[1].status.has(StatusFlag::degraded_model));
  }
  CHECK(servo.tick_view().contact_rows() > 0);
}

TEST_CASE("the vertices of a grasped pad follow the tool as one, while other tools press beside it",
          "[contact][grasp][pad]") {
  test::Pad pad = test::make_pad();
  ServoOptions options;
  options.force_limits = test::open_gate();
  options.coupling_stiffness = infinity;
  options.grasp_buttons = 1;
  options.contact.grasp_radius = 6e-3;
  test::ServoSession session(pad, options, 2);
  session.states[0].position = Vector3(0.01, 0.015, test::pad_height + test::sphere_radius);
  session.states[1].position = Vector3(0.02, 0.015, test::pad_height + test::sphere_radius + 1e-3);
  for (int k = 0; k < 20; ++k) {
    session.states[0].position[2] -= 5e-5;
    session.tick();
  }
  const double pressed = session.forces[0].force().norm();
  session.states[0].buttons = 1;
  session.tick();
  CHECK(std::abs(session.forces[0].force().norm() - pressed) < 0.5 * pressed);
  std::vector<int> vertices;
  for (const ToolContact& c : session.servo.read_snapshot().tool_contacts())
    if (c.grasped) vertices.push_back(c.vertices[0]);
  REQUIRE(vertices.size() >= 3);
  const auto moved = [&](int v) {
    return test::deformed_surface(pad, session.servo.read_snapshot().vertex_forces())[static_cast<std::size_t>(v)];
  };
  std::vector<Vector3> grasped_at;
  for (const int v : vertices) grasped_at.push_back(moved(v));
  const Vector3 from = session.states[0].position;
  for (int k = 0; k < 60; ++k) {
    session.states[0].position += Vector3(-2e-5, 0.0, 5e-5);
    session.states[1].position[2] -= 4e-5;
    session.tick();
  }
  const Vector3 by = session.servo.read_snapshot().proxies[0] - from;
  CHECK(session.servo.read_snapshot().contact_force(1).norm() > 0.0);
  for (std::size_t i = 0; i < vertices.size(); ++i)
    CHECK((moved(vertices[i]) - grasped_at[i] - by).norm() < 0.02 * by.norm());
}
