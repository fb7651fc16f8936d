#include "picture.hpp"

#include <palpate/post/colour_map.hpp>

#include <numbers>

#include "shaders.hpp"
#include "shapes.hpp"

namespace live {

namespace {

void load(TriangleBuffer& buffer, const DrawnSurface& surface) {
  buffer.set_points(surface.positions, surface.normals, surface.values);
  buffer.set_triangles(surface.triangles);
}

const Vector3 steel(0.62, 0.65, 0.70), orange(0.93, 0.45, 0.13), teal(0.05, 0.52, 0.55), violet(0.45, 0.28, 0.62);

}  // namespace

Picture::Picture()
    : lit_(shaders::lit_vertex, shaders::lit_fragment),
      sky_(shaders::sky_vertex, shaders::sky_fragment),
      shadow_(shaders::shadow_vertex, shaders::shadow_fragment),
      table_(palette<256>(ColourMap::rose_blue)) {
  load(sphere_, unit_sphere());
  load(cylinder_, unit_cone(1.0));
  load(cone_, unit_cone(0.0));
  load(box_, unit_box());
  load(floor_, unit_floor());
  glGenVertexArrays(1, &empty_array_);
}

void Picture::draw(Stage& stage, const PictureOptions& options) {
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_LEQUAL);
  glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
  draw_sky();
  if (stage.organ() == nullptr) return;
  const DrawnSurface& surface = stage.look();
  if (surface.triangles.empty()) return;

  const Camera& camera = stage.camera();
  const Eigen::Matrix4d view_projection = camera.projection() * camera.view();
  for (const Shader* shader : {&shadow_, &lit_}) {
    shader->use();
    shader->set("view_projection", view_projection);
    shader->set("eye", camera.eye());
    shader->set("key", Vector3(-0.5 * camera.forward() - 0.35 * camera.right() + 0.8 * Vector3::UnitZ()).normalized());
  }
  draw_floor(surface);
  draw_organ(stage, surface, options);
  if (options.forces) draw_forces(stage.snapshot());
  for (std::size_t i = 0; i < stage.tools().size(); ++i) draw_tool(stage, i);
}

void Picture::draw_sky() const {
  glDepthMask(GL_FALSE);
  sky_.use();
  glBindVertexArray(empty_array_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glDepthMask(GL_TRUE);
}

void Picture::draw_floor(const DrawnSurface& surface) {
  Vector3 low = surface.position(0), high = low;
  for (int i = 1; i < static_cast<int>(surface.values.size()); ++i) {
    low = low.cwiseMin(surface.position(i));
    high = high.cwiseMax(surface.position(i));
  }
  const Vector3 middle = 0.5 * (low + high), size = high - low;
  shadow_.use();
  shadow_.set("model",
              placed({middle.x(), middle.y(), low.z() - 0.02 * size.norm()}, {0.68 * size.x(), 0.72 * size.y(), 1.0}));
  glEnable(GL_BLEND);
  glDepthMask(GL_FALSE);
  floor_.draw();
  glDepthMask(GL_TRUE);
  glDisable(GL_BLEND);
}

void Picture::draw_organ(Stage& stage, const DrawnSurface& surface, const PictureOptions& options) {
  if (shown_ != stage.organ() || revision_ != surface.revision) {
    organ_.set_triangles(surface.triangles);
    if (shown_ != stage.organ() && !stage.scene().hidden_region.empty())
      load(hidden_, stage.organ()->region(stage.scene().hidden_region));
    shown_ = stage.organ();
    revision_ = surface.revision;
  }
  organ_.set_points(surface.positions, surface.normals, surface.values);
  const bool reveal = options.reveal && !stage.scene().hidden_region.empty();
  if (reveal) paint(hidden_, Eigen::Matrix4d::Identity(), {orange});

  lit_.use();
  lit_.set("model", Eigen::Matrix4d(Eigen::Matrix4d::Identity()));
  lit_.set("low", options.low);
  lit_.set("high", options.high);
  lit_.set("use_table", 1.0);
  lit_.set("alpha", reveal ? 0.55 : 1.0);
  lit_.set("gloss", 0.22);
  table_.use();
  if (reveal) {  // first the depth alone: only the layer in front is mixed with what is behind
    glColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    organ_.draw();
    glColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    glEnable(GL_BLEND);
  }
  organ_.draw();
  glDisable(GL_BLEND);
}

void Picture::paint(const TriangleBuffer& shape, const Eigen::Matrix4d& model, const Paint& paint) {
  lit_.use();
  lit_.set("model", model);
  lit_.set("use_table", 0.0);
  lit_.set("base", paint.colour);
  lit_.set("alpha", paint.alpha);
  lit_.set("gloss", paint.gloss);
  if (paint.alpha < 1.0) glEnable(GL_BLEND);
  shape.draw();
  glDisable(GL_BLEND);
}

/// The tool where the surface lets it be, and the device where the hand is: the spring between them is the force.
void Picture::draw_tool(Stage& stage, std::size_t tool) {
  const ServoSnapshot& snapshot = stage.snapshot();
  if (snapshot.tool_count <= tool || !(snapshot.time > 0.0)) return;
  const Vector3 proxy = snapshot.proxies[tool], device = stage.log(tool).newest().tick.state.position;
  const double radius = radius_of(stage.tools()[tool]);
  const Vector3 shaft = Vector3(tool == 0 ? 0.35 : -0.35, -0.30, 0.89) * 0.14;
  if (const auto* blade = std::get_if<BladeTool>(&stage.tools()[tool])) {
    const double length = blade->edge.norm();
    Eigen::Matrix4d plate = Eigen::Matrix4d::Identity();
    plate.block<3, 1>(0, 0) = 8e-4 * Vector3::UnitZ().cross(blade->edge).normalized();
    plate.block<3, 1>(0, 1) = blade->edge;
    plate.block<3, 1>(0, 2) = Vector3(0.0, 0.0, 0.6 * length);
    plate.block<3, 1>(0, 3) = proxy + Vector3(0.0, 0.0, 0.3 * length);
    paint(box_, plate, {steel, 1.0, 0.9});
    paint(cylinder_, between(proxy + Vector3(0.0, 0.0, 0.55 * length), proxy + Vector3(0.0, 0.0, 0.14), 2e-3),
          {steel, 1.0, 0.7});
  } else {
    paint(sphere_, placed(proxy, Vector3::Constant(radius)), {tool == stage.hand().active() ? teal : violet, 1.0, 0.6});
    paint(cylinder_, between(proxy, proxy + shaft, 0.22 * radius), {steel, 1.0, 0.7});
  }
  if ((device - proxy).norm() < 2e-4) return;
  draw_spring(proxy, device);
  glDisable(GL_DEPTH_TEST);  // the hand is inside the organ: it shows through
  paint(sphere_, placed(device, Vector3::Constant(std::max(1.5e-3, 0.3 * radius))), {orange, 0.75, 0.3});
  glEnable(GL_DEPTH_TEST);
}

void Picture::draw_spring(const Vector3& from, const Vector3& to) {
  glDisable(GL_DEPTH_TEST);
  paint(cylinder_, between(from, to, 4e-4), {orange, 0.8});
  glEnable(GL_DEPTH_TEST);
}

void Picture::draw_forces(const ServoSnapshot& snapshot) {
  for (const ToolContact& contact : snapshot.tool_contacts()) {
    paint(sphere_, placed(contact.point, Vector3::Constant(contact.grasped ? 1.6e-3 : 8e-4)), {orange});
    if (contact.grasped) continue;  // the points of a pad pull against each other; the sum is drawn below
    draw_arrow(contact.point, contact.force * contact.normal + contact.friction, 5e-4, {orange, 0.9});
  }
  for (std::size_t i = 0; i < snapshot.tool_count; ++i)
    draw_arrow(snapshot.proxies[i], snapshot.contact_force(i), 1.4e-3, {Vector3(0.85, 0.20, 0.12)});
}

void Picture::draw_arrow(const Vector3& from, const Vector3& force, double radius, const Paint& of) {
  const double length = std::min(arrow * force.norm(), 0.12);
  if (!(length > 3.0 * radius)) return;
  const Vector3 direction = force.normalized();
  const double head = std::min(6.0 * radius, 0.5 * length);
  paint(cylinder_, between(from, from + (length - head) * direction, radius), of);
  paint(cone_, between(from + (length - head) * direction, from + length * direction, 2.4 * radius), of);
}

}  // namespace live
