// The functions of palpate_scene.
#pragma once

#include <palpate/c/detail/handles.hpp>

#include <cmath>
#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface { namespace {

Vector3 vector3(const double* given, const char* name) {
  return Vector3(numbers(given, 3, name).data());
}

/// Adds to a scene: f(scene, name of the group).
template <class F>
palpate_error add_to(palpate_scene* scene, const char* group, F&& f) noexcept {
  return guarded([&] { f(object(scene, "scene").scene, text(group, "group")); });
}

}  // namespace

}}}  // namespace palpate::PALPATE_ABI::c_interface

extern "C" {

palpate_error palpate_scene_create(palpate_scene** scene) {
  using namespace palpate::c_interface;
  return guarded([&] { target(scene, "scene") = new palpate_scene; });
}

palpate_error palpate_scene_fix(palpate_scene* scene, const char* group) {
  return palpate::c_interface::add_to(scene, group, [](palpate::Scene& s, std::string g) { s.fix(std::move(g)); });
}

palpate_error palpate_scene_prescribe(palpate_scene* scene, const char* group, const double* displacement) {
  using namespace palpate::c_interface;
  return add_to(scene, group, [&](palpate::Scene& s, std::string g) {
    const palpate::Vector3 u = vector3(displacement, "displacement");
    palpate::Components components;
    for (int c = 0; c < 3; ++c)
      if (!std::isnan(u[c])) components[static_cast<std::size_t>(c)] = u[c];
    s.prescribe(std::move(g), components);
  });
}

palpate_error palpate_scene_traction(palpate_scene* scene, const char* group, const double* traction) {
  using namespace palpate::c_interface;
  return add_to(scene, group,
                [&](palpate::Scene& s, std::string g) { s.traction(std::move(g), vector3(traction, "traction")); });
}

palpate_error palpate_scene_pressure(palpate_scene* scene, const char* group, double pressure) {
  return palpate::c_interface::add_to(scene, group,
                                      [&](palpate::Scene& s, std::string g) { s.pressure(std::move(g), pressure); });
}

palpate_error palpate_scene_point_load(palpate_scene* scene, const char* group, const double* force) {
  using namespace palpate::c_interface;
  return add_to(scene, group,
                [&](palpate::Scene& s, std::string g) { s.point_load(std::move(g), vector3(force, "force")); });
}

palpate_error palpate_scene_gravity(palpate_scene* scene, const double* acceleration) {
  using namespace palpate::c_interface;
  return guarded([&] { object(scene, "scene").scene.gravity(vector3(acceleration, "acceleration")); });
}

palpate_error palpate_scene_touch(palpate_scene* scene, const char* group, double radius) {
  return palpate::c_interface::add_to(
      scene, group, [&](palpate::Scene& s, std::string g) { s.touch(std::move(g), {.radius = radius}); });
}

palpate_error palpate_scene_render(palpate_scene* scene, const char* group) {
  return palpate::c_interface::add_to(scene, group, [](palpate::Scene& s, std::string g) { s.render(std::move(g)); });
}

void palpate_scene_destroy(palpate_scene* scene) {
  if (scene == nullptr || scene->tag.value != palpate_scene::kind) return;
  scene->tag.value = 0;
  delete scene;
}

}  // extern "C"
