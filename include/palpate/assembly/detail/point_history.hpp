// Viscoelastic history of the integration points of a body.
#pragma once

#include <palpate/assembly/body.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/viscoelastic.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// No history: the material of a point is that of its region, and steps cost nothing.
struct NoHistory {
  template <class Body>
  void start(const Body&, const SetupLimits&) noexcept {}
  template <class Body>
  static decltype(auto) material(const Body& body, Index e, std::size_t) noexcept {
    return body.material_of(e);
  }
};

/// The history of a Prony series: (2 + terms) x 72 bytes per point. Only `start` allocates.
template <ViscousMaterial M, std::size_t Points>
class PronyPoints {
 public:
  /// Initialises the history at rest and begins a step of length 0.
  template <class Body>
  void start(const Body& body, const SetupLimits& limits) {
    const auto count = static_cast<std::size_t>(body.rest.mesh.element_count());
    limits.require_memory(static_cast<double>(count) * Points * sizeof(Point),
                          "the viscoelastic history of the integration points");
    points_.resize(count);
    steps_.resize(body.materials.size());
    begin_step(body, 0.0);
  }

  template <class Body>
  auto material(const Body& body, Index e, std::size_t q) const noexcept {
    const Point& point = points_[static_cast<std::size_t>(e)][q];
    return body.material_of(e).material_of_step(steps_[body.rest.region_of(e)], point.driving);
  }

  template <class Body>
  void begin_step(const Body& body, double dt) noexcept {
    for (std::size_t r = 0; r < steps_.size(); ++r) steps_[r] = body.materials[r].over(dt);
    for (std::size_t e = 0; e < points_.size(); ++e)
      for (Point& point : points_[e])
        point.driving = M::driving_stress(point.history, steps_[body.rest.region_of(static_cast<Index>(e))]);
  }
  template <class Body>
  void update_history(const Body& body, Index e, std::size_t q, const Tensor3<double>& f) noexcept {
    if (body.material_of(e).admits(f))
      body.material_of(e).update_history(f, points_[static_cast<std::size_t>(e)][q].history,
                                         steps_[body.rest.region_of(e)]);
  }

 private:
  struct Point {
    typename M::LargeStrainHistory history;
    Tensor3<double> driving{};
  };

  std::vector<std::array<Point, Points>> points_;
  std::vector<decltype(std::declval<const M&>().over(0.0))> steps_;  // by region
};

template <class M, std::size_t Points>
struct PointHistory {
  using type = NoHistory;
};
template <ViscousMaterial M, std::size_t Points>
struct PointHistory<M, Points> {
  using type = PronyPoints<M, Points>;
};

}}}  // namespace palpate::detail
