// Definitions of measure_force_error.hpp.
#pragma once

#include <palpate/model/static/detail/measure_force_error.hpp>

#include <palpate/mesh/refine_near.hpp>
#include <palpate/model/static/detail/reference_tissue.hpp>
#include <palpate/model/static/detail/tetrahedral_copy.hpp>
#include <palpate/model/static/detail/thin_body.hpp>

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE ForceErrorMeasurement::ForceErrorMeasurement(const ForceErrorSource& source) : source_(source) {
  report_.radius = source.radius;
  choose_places();
  if (places_.empty()) report_.remark = "the touchable surface has no vertex away from its rim and its supports";
}

PALPATE_INLINE ForceErrorMeasurement::Facets ForceErrorMeasurement::facets_at(int vertex) const {
  Facets scale;
  const auto triangles = source_.surface.triangles_at(vertex);
  for (const int t : triangles) {
    const double share = 1.0 / static_cast<double>(triangles.size());
    scale.length += share * source_.surface.facet_length(t);
    scale.modulus += share * source_.surface.material(t).modulus;
  }
  return scale;
}

/// Mean of the normals around a vertex.
PALPATE_INLINE Vector3 ForceErrorMeasurement::outward_at(int vertex) const {
  Vector3 sum = Vector3::Zero();
  for (const int t : source_.surface.triangles_at(vertex)) sum += source_.surface.normal(t);
  return sum.normalized();
}

/// Whether a vertex is supported against a press: a force on it shows nothing of the tissue.
PALPATE_INLINE bool ForceErrorMeasurement::is_supported(int vertex) const {
  constexpr double most = 0.1;  // square of the part of the normal that is constrained
  const Vector3 outward = outward_at(vertex);
  const Index dof = 3 * Index{source_.nodes[static_cast<std::size_t>(vertex)]};
  double constrained = 0.0;
  for (int c = 0; c < 3; ++c)
    if (source_.conditions.is_constrained(dof + c)) constrained += outward[c] * outward[c];
  return constrained > most;
}

/// Vertices away from the rim, and from supports on the same side of the body, by more than a radius and a facet. On a
/// surface that is too small for that many places: by more than the radius of the deepest contact, since one place does
/// not show how places differ. On a smaller one the vertex farthest from the rim and supports.
PALPATE_INLINE std::vector<int> ForceErrorMeasurement::inner_vertices() const {
  constexpr double same_side = -0.1;  // cosine, with room for rounding
  const ContactSurface& surface = source_.surface;
  const double contact = std::sqrt(source_.radius * depths().back());  // of Hertz
  std::vector<SurfacePoint> rim;                                       // without a normal: of any side
  for (int v = 0; v < surface.vertex_count(); ++v) {
    if (surface.triangles_at(v).empty()) continue;
    if (surface.is_rim_vertex(v)) rim.push_back({surface.position(v), Vector3::Zero()});
    if (is_supported(v)) rim.push_back({surface.position(v), outward_at(v)});
  }
  std::vector<int> inner, nearer;
  int farthest = -1;
  double largest = 0.0;
  for (int v = 0; v < surface.vertex_count(); ++v) {
    if (surface.triangles_at(v).empty()) continue;
    double square = infinity;
    const Vector3 outward = outward_at(v);
    for (const SurfacePoint& p : rim)
      if (p.outward.dot(outward) > same_side)
        square = std::min(square, (p.position - surface.position(v)).squaredNorm());
    if (std::sqrt(square) > source_.radius + facets_at(v).length) inner.push_back(v);
    if (std::sqrt(square) > contact) nearer.push_back(v);
    if (square > largest) {
      largest = square;
      farthest = v;
    }
  }
  if (static_cast<int>(inner.size()) < source_.places && !nearer.empty()) inner = std::move(nearer);
  if (inner.empty() && farthest >= 0) inner.push_back(farthest);
  return inner;
}

/// Farthest point sampling, from the vertex nearest to the middle of the surface. Where nothing can be pinched at these
/// places, but at another one, that is added.
PALPATE_INLINE void ForceErrorMeasurement::choose_places() {
  const ContactSurface& surface = source_.surface;
  std::vector<int> vertices = inner_vertices();
  Vector3 middle = Vector3::Zero();
  for (const int v : vertices) middle += surface.position(v) / static_cast<double>(vertices.size());
  const auto from = [&](const Vector3& p) {
    return [&surface, p](int a, int b) {
      return (surface.position(a) - p).squaredNorm() < (surface.position(b) - p).squaredNorm();
    };
  };
  std::vector<double> distance(vertices.size(), infinity);
  int next = vertices.empty() ? -1 : *std::min_element(vertices.begin(), vertices.end(), from(middle));
  while (next >= 0 && static_cast<int>(places_.size()) < source_.places) {
    places_.push_back(place_at(next));
    double farthest = 0.0;
    const Vector3 last = surface.position(next);
    next = -1;
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      distance[i] = std::min(distance[i], (surface.position(vertices[i]) - last).squaredNorm());
      if (distance[i] > farthest) {
        farthest = distance[i];
        next = vertices[i];
      }
    }
  }
  const auto can_be_pinched = [](const Place& p) { return p.opposite.front().has_value(); };
  if (!source_.pinched || std::ranges::any_of(places_, can_be_pinched)) return;
  for (const int v : vertices)
    if (Place place = place_at(v); can_be_pinched(place)) {
      places_.push_back(std::move(place));
      return;
    }
  report_.remark = "nothing is pinched: the touchable surface has no opposite sides";
}

PALPATE_INLINE ForceErrorMeasurement::Place ForceErrorMeasurement::place_at(int vertex) const {
  const ContactSurface& surface = source_.surface;
  const auto at = surface.triangles_at(vertex);
  std::vector<int> triangles(at.begin(), at.end());
  const auto middle = triangles.begin() + static_cast<std::ptrdiff_t>(triangles.size() / 2);
  std::nth_element(triangles.begin(), middle, triangles.end(),
                   [&](int a, int b) { return surface.facet_length(a) < surface.facet_length(b); });
  const Facets scale = facets_at(vertex);
  Place place;
  place.vertex = vertex;
  place.triangle = *middle;
  place.length = scale.length;
  place.modulus = scale.modulus;
  if (!source_.pinched) return place;
  const Positions at_rest = points(place, [&](int v) -> Vector3 { return surface.position(v); });
  for (std::size_t p = 0; p < at_rest.size(); ++p) place.opposite[p] = opposite_of(at_rest[p]);
  return place;
}

/// The nearest point behind, if the surface there faces away within 45 degrees: a sphere on a steep side would slip.
/// None on a support, against which a single sphere presses as well.
PALPATE_INLINE std::optional<ForceErrorMeasurement::Spot> ForceErrorMeasurement::opposite_of(
    const SurfacePoint& point) const {
  constexpr double least_cosine = 0.7;
  const ContactSurface& surface = source_.surface;
  std::optional<Spot> spot;
  double nearest = infinity;
  for (std::size_t t = 0; t < surface.triangles().size(); ++t) {
    const Triangle& v = surface.triangles()[t];
    const auto exit = exit_through(point, surface.position(v[0]), surface.position(v[1]), surface.position(v[2]));
    if (!exit || exit->distance >= nearest) continue;
    nearest = exit->distance;
    spot = Spot{static_cast<int>(t), exit->weights};
  }
  const auto position = [&](int v) -> Vector3 { return surface.position(v); };
  if (spot && point_at(*spot, position).outward.dot(point.outward) > -least_cosine) spot.reset();
  if (spot && std::ranges::any_of(surface.triangle(spot->triangle), [&](int v) { return is_supported(v); }))
    spot.reset();
  return spot;
}

template <class PositionOf>
SurfacePoint ForceErrorMeasurement::point_at(const Spot& spot, PositionOf position) const {
  const Triangle& v = source_.surface.triangle(spot.triangle);
  const Vector3 a = position(v[0]), b = position(v[1]), c = position(v[2]);
  return {spot.weights[0] * a + spot.weights[1] * b + spot.weights[2] * c, (b - a).cross(c - a).normalized()};
}

template <class PositionOf>
ForceErrorMeasurement::Positions ForceErrorMeasurement::points(const Place& place, PositionOf position) const {
  const ContactSurface& surface = source_.surface;
  const auto normal = [&](int t) -> Vector3 {
    const Triangle& v = surface.triangle(t);
    return (position(v[1]) - position(v[0])).cross(position(v[2]) - position(v[0])).normalized();
  };
  const Triangle& corners = surface.triangle(place.triangle);
  const auto at = static_cast<std::size_t>(std::find(corners.begin(), corners.end(), place.vertex) - corners.begin());
  const Vector3 a = position(corners[at]), b = position(corners[(at + 1) % 3]), c = position(corners[(at + 2) % 3]);
  Vector3 mean = Vector3::Zero();
  for (const int t : surface.triangles_at(place.vertex)) mean += normal(t);
  const Vector3 outward = normal(place.triangle);
  return {{{a, mean.normalized()}, {0.5 * (a + b), outward}, {(a + b + c) / 3.0, outward}}};
}

PALPATE_INLINE std::vector<double> ForceErrorMeasurement::depths() const {
  std::vector<double> depths;
  for (const double part : {1.0 / 32.0, 1.0 / 16.0, 1.0 / 8.0, 1.0 / 4.0, 1.0 / 2.0})
    depths.push_back(part * source_.radius);
  return depths;
}

/// Presses every place of a tissue whose surface has these positions of the vertices. Spheres that pinch a thin part
/// would meet at larger depths than the one in the report.
template <class PositionOf>
void ForceErrorMeasurement::press(const TissueView& tissue, int capacity, Presses Compared::*presses,
                                  PositionOf position) {
  const SphereTool sphere{source_.radius};
  const ServoOptions options = rigid_press_options(capacity);
  const std::vector<double> all_depths = depths();
  HapticServo one(tissue, ToolList{sphere}, options, {}), two(tissue, ToolList{sphere, sphere}, options, {});
  for (Place& place : places_) {
    const Positions at = points(place, position);
    for (std::size_t p = 0; p < at.size(); ++p) {
      (place.single.*presses)[p] = press_points(one, source_.radius, {&at[p], 1}, all_depths);
      if (!place.opposite[p]) continue;
      const std::array<SurfacePoint, 2> sides{at[p], point_at(*place.opposite[p], position)};
      (place.pinched.*presses)[p] =
          press_points(two, source_.radius, sides, std::span(all_depths).first(summarised + 1));
    }
  }
}

PALPATE_INLINE void ForceErrorMeasurement::press_given(const TissueView& tissue) {
  press(tissue, 0, &Compared::given, [&](int v) -> Vector3 { return source_.origin + source_.surface.position(v); });
}

PALPATE_INLINE void ForceErrorMeasurement::press_reference(const SetupLimits& limits) {
#if defined(PALPATE_HAS_EXCEPTIONS)
  try {
    make_reference(limits);
  } catch (const SetupError& error) {
    if (error.kind() == SetupErrorKind::cancelled) throw;
    report_.remark = error.what();
    places_.clear();
  }
#else
  make_reference(limits);
#endif
}

PALPATE_INLINE void ForceErrorMeasurement::make_reference(const SetupLimits& limits) {
  constexpr double edges_per_radius = 3.0, growth = 0.5, reach = 0.9;
  constexpr int capacity = 256;
  const auto elasticity = [&](Index e) { return source_.body.elasticity_of(e); };
  std::optional<TetrahedralCopy> copy;
  if (source_.coarse != nullptr) copy = coarse_copy(*source_.coarse, source_.body.mesh(), source_.node_map, elasticity);
  if (!copy) copy = tetrahedral_copy(source_.body.mesh(), elasticity);
  if (!copy) {
    report_.remark = "the fine mesh is made of tetrahedra, and this element cannot be divided into these";
    places_.clear();
    return;
  }
  double thickness = infinity;
  const auto boundary = extract_boundary<Tet4>(copy->mesh);
  double edge = source_.radius / edges_per_radius;
  for (const Place& place : places_) edge = std::min(edge, 0.5 * place.length);
  PointCloud cloud;
  Scene scene;
  std::optional<where::PointSet> touched;
  const auto position = [&](int v) -> Vector3 {  // on the body without loads
    return source_.body.positions()[static_cast<std::size_t>(source_.nodes[static_cast<std::size_t>(v)])];
  };
  const auto add = [&](const Vector3& point) {
    cloud.points.push_back(point);
    where::PointSet near_points = where::sphere(point, reach * source_.radius + 2.0 * edge);
    touched = touched ? *touched || near_points : near_points;
  };
  for (const Place& place : places_) {
    const Positions at = points(place, position);
    thickness = std::min(thickness, thickness_under(at.front(), copy->mesh, boundary));
    for (std::size_t p = 0; p < at.size(); ++p) {
      add(at[p].position);
      if (place.opposite[p]) add(point_at(*place.opposite[p], position).position);
    }
  }
  scene.touch(*touched);
  for (std::size_t c = 0; c < 3; ++c) {
    std::vector<NodeId> fixed;
    for (std::size_t i = 0; i < copy->nodes.size(); ++i)
      if (copy->nodes[i] >= 0 && source_.conditions.is_constrained(static_cast<Index>(3 * i + c)))
        fixed.push_back(copy->nodes[i]);
    if (fixed.empty()) continue;
    const std::string name = std::string("fixed ") + "xyz"[c];
    copy->mesh.groups.get_or_add(name, 0).nodes = fixed;
    Components components{};
    components[c] = 0.0;
    scene.prescribe(name, components);
  }
  copy->mesh.groups.tidy();
  Mesh<Tet4> fine = refine_near(copy->mesh, RefineTarget(std::move(cloud)), {edge, growth});
  if (!refine_through(fine, thickness)) bending_doubt_ = std::min(1.0, std::pow(places_.front().length / thickness, 2));
  report_.nodes = fine.node_count();
  const std::span<const Matrix6> elasticities = source_.body.elasticities();
  ReferenceTissue tissue(std::move(fine), {elasticities.begin(), elasticities.end()}, scene,
                         {.progress = limits.progress, .memory_limit = limits.memory});
  press(TissueView(tissue), capacity, &Compared::reference, position);
  summarise();
}

/// Missing depth at a place, position and depth, relative to the indentation; nothing where the sphere does not press.
PALPATE_INLINE std::optional<double> ForceErrorMeasurement::relative_missing(const Place& place, std::size_t position,
                                                                             std::size_t depth) const {
  const double force = place.single.given[position][depth].force;
  const double truth = place.single.reference[position][depth].force;
  if (!(truth > 0.0) || !(force > 1e-3 * truth)) return std::nullopt;
  return force / truth - 1.0;
}

/// Places differ although their facets are of equal length: a part of the largest difference between a place and the
/// others, at equal depth, is added to its doubt. At equal force it would be large on a lobe, which is softer at its
/// end than at its root.
PALPATE_INLINE MissingDepth ForceErrorMeasurement::missing(const Place& place) const {
  constexpr double least_doubt = 0.01;      // of the force: places with the same facets differ by that
  constexpr double reference_doubt = 0.01;  // of the force on the fine mesh
  constexpr double part = 0.3;
  MissingDepth result;
  result.facet_length = place.length;
  const std::vector<double> depth = depths();
  for (std::size_t p = 0; p < MissingDepth::positions; ++p)
    for (std::size_t i = 0; i < depth.size(); ++i) {
      const auto [force, indentation] = place.single.given[p][i];
      const double truth = place.single.reference[p][i].force;
      const std::optional<double> relative = relative_missing(place, p, i);
      auto& levels = result.levels[p];
      if (!relative) {
        if (truth > 0.0) result.unseen[p] = truth;
        continue;
      }
      if (!levels.empty() && force <= levels.back().force) continue;
      double spread = 0.0;
      for (const Place& other : places_)
        spread = std::max(spread, std::abs(relative_missing(other, p, i).value_or(*relative) - *relative));
      const double doubt = reference_doubt * force / truth + least_doubt + bending_doubt_ + part * spread;
      levels.push_back({force, *relative * indentation, doubt * indentation});
    }
  return result;
}

/// Single spheres and pinches are not mixed: most places of a body can often not be pinched, and would hide the others.
PALPATE_INLINE void ForceErrorMeasurement::summarise() {
  for (const Compared Place::*kind : {&Place::single, &Place::pinched}) {
    double squares = 0.0;
    int compared = 0, places = 0;
    for (const Place& place : places_) {
      const int before = compared;
      for (std::size_t p = 0; p < MissingDepth::positions; ++p) {
        const auto& [given, reference] = place.*kind;
        if (reference[p].empty()) continue;
        const double truth = reference[p][summarised].force;
        if (!(truth > 0.0)) continue;
        const double error = given[p][summarised].force / truth - 1.0;
        squares += error * error;
        ++compared;
        if (std::abs(error) > std::abs(report_.largest)) report_.largest = error;
      }
      places += compared > before;
    }
    if (compared > 0) report_.typical = std::max(report_.typical, std::sqrt(squares / compared));
    if (kind == &Place::pinched) {
      report_.pinched = places;
    } else if (compared == 0) {
      report_.remark = "the sphere does not press the fine mesh at any of the places";
      return;
    }
  }
  for (const Place& place : places_) report_.facet += place.length / static_cast<double>(places_.size());
  report_.places = static_cast<int>(places_.size());
}

PALPATE_INLINE std::vector<SurfacePoint> ForceErrorMeasurement::points() const {
  std::vector<SurfacePoint> result;
  const auto position = [&](int v) -> Vector3 { return source_.origin + source_.surface.position(v); };
  for (const Place& place : places_) result.push_back(points(place, position).front());
  return result;
}

PALPATE_INLINE AccuracyReport ForceErrorMeasurement::compared(const TissueView& tissue) const {
  ForceErrorMeasurement other(*this);
  other.report_.typical = other.report_.largest = other.report_.facet = 0.0;
  other.report_.places = other.report_.pinched = 0;
  other.press_given(tissue);
  other.summarise();
  return other.report_;
}

/// A vertex has the values of the nearest place.
PALPATE_INLINE std::shared_ptr<const ForceAccuracy> ForceErrorMeasurement::take() const {
  if (report_.places == 0) return nullptr;
  const ContactSurface& surface = source_.surface;
  std::vector<MissingDepth> errors;
  for (const Place& place : places_) errors.push_back(missing(place));
  std::vector<ForceAccuracy::Vertex> vertices;
  for (int v = 0; v < surface.vertex_count(); ++v) {
    const auto distance = [&](const Place& p) {
      return (surface.position(p.vertex) - surface.position(v)).squaredNorm();
    };
    const auto place = std::min_element(places_.begin(), places_.end(),
                                        [&](const Place& a, const Place& b) { return distance(a) < distance(b); });
    const Facets own = facets_at(v);
    const bool known = own.modulus > 0.0 && place->modulus > 0.0;
    vertices.push_back({static_cast<int>(place - places_.begin()), own.length > 0.0 ? own.length : place->length,
                        known ? place->modulus / own.modulus : 1.0});
  }
  return std::make_shared<const ForceAccuracy>(source_.radius, std::move(errors), std::move(vertices));
}

PALPATE_INLINE std::shared_ptr<const ForceAccuracy> measure_force_error(const ForceErrorSource& source,
                                                                        const TissueView& tissue,
                                                                        const SetupLimits& limits,
                                                                        SetupReport& report) {
  ForceErrorMeasurement measurement(source);
  if (measurement.is_possible()) {
    measurement.press_given(tissue);
    measurement.press_reference(limits);
  }
  report_accuracy(measurement.report(), report);
  return measurement.take();
}

PALPATE_INLINE void report_accuracy(const AccuracyReport& accuracy, SetupReport& report) {
  constexpr double flagged = 0.1, wanted = 0.05, order = 1.5;
  report.accuracy = accuracy;
  if (accuracy.places == 0 || !(accuracy.typical > flagged)) return;
  const auto percent = [](double part) { return number(std::round(100.0 * part)) + " %"; };
  const double edge = accuracy.facet * std::pow(wanted / accuracy.typical, 1.0 / order);
  report.set(SetupFlag::coarse_contact, "the facets, " + number(std::round(1e4 * accuracy.facet) / 10.0) +
                                            " mm long, are too long for a sphere of " + number(1e3 * accuracy.radius) +
                                            " mm: pressed in by an eighth of its radius, its force is in error by " +
                                            percent(accuracy.typical) + ", at one place by " +
                                            percent(accuracy.largest) + "; refine_near with an edge of about " +
                                            number(std::round(1e4 * edge) / 10.0) + " mm");
}

}}}  // namespace palpate::detail
