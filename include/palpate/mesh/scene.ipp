// Definitions of scene.hpp.
#pragma once

#include <palpate/mesh/scene.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE Scene::Scene() = default;
PALPATE_INLINE Scene::Scene(const Scene&) = default;
PALPATE_INLINE Scene::Scene(Scene&&) noexcept = default;
PALPATE_INLINE Scene& Scene::operator=(const Scene&) = default;
PALPATE_INLINE Scene& Scene::operator=(Scene&&) noexcept = default;
PALPATE_INLINE Scene::~Scene() = default;

PALPATE_INLINE Scene& Scene::fix(Selection where) {
  return prescribe(std::move(where), {0.0, 0.0, 0.0});
}

PALPATE_INLINE Scene& Scene::prescribe(Selection where, Components values) {
  for (const auto& v : values) require_finite(v.value_or(0.0), "a prescribed displacement");
  prescribed_.push_back({std::move(where), values});
  return *this;
}

PALPATE_INLINE Scene& Scene::traction(Selection where, const Vector3& value) {
  require_finite(value.sum(), "a traction");
  tractions_.push_back({std::move(where), value});
  return *this;
}

PALPATE_INLINE Scene& Scene::pressure(Selection where, double value) {
  require_finite(value, "a pressure");
  pressures_.push_back({std::move(where), value});
  return *this;
}

PALPATE_INLINE Scene& Scene::point_load(Selection where, const Vector3& force) {
  require_finite(force.sum(), "a point load");
  point_loads_.push_back({std::move(where), force});
  return *this;
}

PALPATE_INLINE Scene& Scene::gravity(const Vector3& acceleration) {
  require_finite(acceleration.sum(), "gravity");
  gravity_ = acceleration;
  return *this;
}

PALPATE_INLINE Scene& Scene::body_load(std::string region, const Vector3& force_per_volume) {
  require_finite(force_per_volume.sum(), "a body load");
  body_loads_.push_back({std::move(region), force_per_volume});
  return *this;
}

PALPATE_INLINE Scene& Scene::initial_strain(std::string region, const Vector6& strain) {
  require_finite(strain.sum(), "an initial strain");
  initial_strains_.push_back({std::move(region), strain});
  return *this;
}

PALPATE_INLINE Scene& Scene::expand(std::string region, double elongation) {
  require_finite(elongation, "an expansion");
  if (!(elongation > -1.0))
    raise(SetupErrorKind::bad_argument, "an expansion of " + number(elongation) + " leaves no length",
          "It is relative: 0.01 for one per cent");
  Vector6 strain = Vector6::Zero();
  strain[0] = strain[1] = strain[2] = elongation;
  return initial_strain(std::move(region), strain);
}

PALPATE_INLINE Scene& Scene::thermal_strain(std::string region, double coefficient, double rise) {
  require_finite(coefficient, "a coefficient of expansion");
  require_finite(rise, "a rise of temperature");
  return expand(std::move(region), coefficient * rise);
}

PALPATE_INLINE Scene& Scene::touch(Selection where, const TouchOptions& options) {
  require_finite(options.radius, "the radius of a tool");
  if (options.radius < 0.0)
    raise(SetupErrorKind::bad_argument, "the radius of a tool is " + number(options.radius) + " m",
          "Give a positive radius, or none");
  if (options.radius > 0.0)
    touch_radius_ = touch_radius_ > 0.0 ? std::min(touch_radius_, options.radius) : options.radius;
  is_pinched_ = is_pinched_ || options.pinched;
  touched_.push_back(std::move(where));
  return *this;
}

PALPATE_INLINE Scene& Scene::render(Selection where) {
  rendered_.push_back(std::move(where));
  return *this;
}

PALPATE_INLINE Selection mapped(const Selection& selection, const std::vector<NodeId>& map, const Vector3& origin) {
  if (const auto* points = std::get_if<where::PointSet>(&selection)) return points->relative_to(origin);
  const auto* nodes = std::get_if<std::vector<NodeId>>(&selection);
  if (nodes == nullptr) return selection;
  std::vector<NodeId> mapped_nodes;
  for (NodeId node : *nodes) {
    if (node < 0 || static_cast<std::size_t>(node) >= map.size())
      raise(SetupErrorKind::index_out_of_range,
            "the scene names node " + std::to_string(node) + ", the mesh has " + std::to_string(map.size()));
    if (map[static_cast<std::size_t>(node)] >= 0) mapped_nodes.push_back(map[static_cast<std::size_t>(node)]);
  }
  return mapped_nodes;
}

PALPATE_INLINE Scene Scene::mapped(const std::vector<NodeId>& map, const Vector3& origin) const {
  return with_selections([&](const Selection& selection) { return palpate::mapped(selection, map, origin); });
}

PALPATE_INLINE Scene Scene::with_selections(const std::function<Selection(const Selection&)>& change) const {
  Scene s = *this;
  const auto renew = [&](Selection& selection) { selection = change(selection); };
  for (auto& c : s.prescribed_) renew(c.where);
  for (auto& c : s.tractions_) renew(c.where);
  for (auto& c : s.pressures_) renew(c.where);
  for (auto& c : s.point_loads_) renew(c.where);
  for (auto& c : s.touched_) renew(c);
  for (auto& c : s.rendered_) renew(c);
  return s;
}

PALPATE_INLINE std::string Scene::loads_in_words() const {
  std::string words;
  const auto add = [&](const std::string& what) { words += (words.empty() ? "" : ", ") + what; };
  const auto count = [&](std::size_t n, const char* one, const char* more) {
    if (n > 0) add(std::to_string(n) + ' ' + (n == 1 ? one : more));
  };
  count(tractions_.size(), "traction", "tractions");
  count(pressures_.size(), "pressure", "pressures");
  count(point_loads_.size(), "point load", "point loads");
  count(body_loads_.size(), "body load", "body loads");
  count(initial_strains_.size(), "initial strain", "initial strains");
  bool moves = false;
  for (const Prescribed& p : prescribed_)
    for (const auto& value : p.values) moves = moves || value.value_or(0.0) != 0.0;
  if (moves) add("prescribed displacements");
  return words;
}

namespace detail {

PALPATE_INLINE std::string loads_in_words(const Vector3& gravity, const std::string& others) {
  if (gravity.isZero(0.0)) return others.empty() ? "none" : others;
  return "gravity of " + number(gravity.norm()) + " m/s^2" + (others.empty() ? "" : ", " + others);
}

}  // namespace detail

PALPATE_INLINE std::vector<std::string> Scene::group_names() const {
  std::vector<std::string> names;
  const auto add = [&](const Selection& s) {
    if (const auto* name = std::get_if<std::string>(&s)) names.push_back(*name);
  };
  for (const auto& c : prescribed_) add(c.where);
  for (const auto& c : tractions_) add(c.where);
  for (const auto& c : pressures_) add(c.where);
  for (const auto& c : point_loads_) add(c.where);
  for (const auto& c : touched_) add(c);
  for (const auto& c : rendered_) add(c);
  return names;
}

PALPATE_INLINE void Scene::require_finite(double value, const char* what) {
  if (!std::isfinite(value)) raise(SetupErrorKind::non_finite, std::string(what) + " is not finite");
}

}}  // namespace palpate
