// Measures the error of contact forces because of the mesh, at set-up.
#pragma once

#include <palpate/contact/force_accuracy.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/static/detail/force_error_source.hpp>
#include <palpate/model/static/detail/pressed_points.hpp>

#include <memory>
#include <optional>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Presses a sphere into the tissue at some places of its surface, far from each other: over a vertex, an edge and a
/// facet, to depths of a 32nd to a half of its radius; then into Smoothed<Tet4> tissue on a mesh with edges of at most
/// a third of the radius there and at most a third of the body's thickness elsewhere, with the same supports. At equal
/// depth the forces differ by the error of the mesh. If the scene is pinched, a second sphere then presses the opposite
/// side as well, to the same depth: a thin part does not bend, so what the mesh misses is a larger part of the depth.
class ForceErrorMeasurement {
 public:
  /// Chooses the places.
  explicit ForceErrorMeasurement(const ForceErrorSource& source);

  /// Places where a sphere can be pressed; without any, `report` has the reason.
  bool is_possible() const noexcept { return !places_.empty(); }
  /// Presses the tissue as given.
  void press_given(const TissueView& tissue);
  /// Makes the fine tissue and presses it. If it cannot be made, `report` has the reason. Throws cancelled.
  void press_reference(const SetupLimits& limits);
  /// The errors, one per vertex; null when nothing was measured.
  std::shared_ptr<const ForceAccuracy> take() const;
  const AccuracyReport& report() const noexcept { return report_; }

  /// The points of the places over vertices, in the frame of the tools.
  std::vector<SurfacePoint> points() const;
  /// The report on another tissue of the same body, pressed at the same points; after `press_reference`. Valid for
  /// tissues that are not displaced by loads.
  AccuracyReport compared(const TissueView& tissue) const;

 private:
  using Positions = std::array<SurfacePoint, MissingDepth::positions>;
  using Presses = std::array<std::vector<PressedPoint>, MissingDepth::positions>;
  static constexpr std::size_t summarised = 2;  // of `depths`: an eighth of the radius, for the report
  struct Compared {
    Presses given, reference;
  };
  /// A point on a triangle of the surface.
  struct Spot {
    int triangle = -1;
    Vector3 weights = Vector3::Zero();
  };
  struct Place {
    int vertex = 0, triangle = 0;
    double length = 0.0, modulus = 0.0;  // of its facets [m], [Pa]
    Compared single, pinched;            // `pinched` is empty where there is no opposite spot
    std::array<std::optional<Spot>, MissingDepth::positions> opposite;
  };

  bool is_supported(int vertex) const;
  Vector3 outward_at(int vertex) const;
  std::vector<int> inner_vertices() const;
  void choose_places();
  Place place_at(int vertex) const;
  std::optional<Spot> opposite_of(const SurfacePoint& point) const;
  /// Means over the triangles at a vertex.
  struct Facets {
    double length = 0.0, modulus = 0.0;  // [m], contact modulus [Pa]
  };
  Facets facets_at(int vertex) const;
  /// The points of a place on a surface with these positions of the vertices.
  template <class PositionOf>
  Positions points(const Place& place, PositionOf position) const;
  template <class PositionOf>
  SurfacePoint point_at(const Spot& spot, PositionOf position) const;
  template <class PositionOf>
  void press(const TissueView& tissue, int capacity, Presses Compared::*presses, PositionOf position);
  std::vector<double> depths() const;
  std::optional<double> relative_missing(const Place& place, std::size_t position, std::size_t depth) const;
  MissingDepth missing(const Place& place) const;
  void make_reference(const SetupLimits& limits);
  void summarise();

  ForceErrorSource source_;
  std::vector<Place> places_;
  double bending_doubt_ = 0.0;  // of the force: of a body that is too thin and large for refine_through
  AccuracyReport report_;
};

/// The measurement of `measured_force_error`. Throws cancelled.
std::shared_ptr<const ForceAccuracy> measure_force_error(const ForceErrorSource& source, const TissueView& tissue,
                                                         const SetupLimits& limits, SetupReport& report);

/// Enters the findings in a report; flags errors above a tenth of the force, with the length of facets that would do.
void report_accuracy(const AccuracyReport& accuracy, SetupReport& report);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/static/detail/measure_force_error.ipp>
#endif
