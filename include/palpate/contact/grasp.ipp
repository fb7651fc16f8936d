// Definitions of grasp.hpp.
#pragma once

#include <palpate/contact/detail/candidates.ipp>  // its inline functions
#include <palpate/contact/grasp.hpp>

#include <algorithm>
#include <numbers>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// The vertices near a point, found from triangle to triangle: none of the opposite side of a thin part.
class PadSearch {
 public:
  PadSearch(const ContactSurface& surface, const Triangle& corners, const Vector3& middle, double radius) noexcept
      : surface_(surface), middle_(middle) {
    for (const int v : corners) found_[static_cast<std::size_t>(count_++)] = {0.0, v};
    for (int next = 0; next < count_; ++next)
      for (const int t : surface.triangles_at(found_[static_cast<std::size_t>(next)].vertex))
        for (const int v : surface.triangle(t)) add(v, radius);
    std::sort(found_.begin(), found_.begin() + count_,
              [](const Found& a, const Found& b) { return a.distance < b.distance; });
  }
  int count() const noexcept { return count_; }
  int vertex(int i) const noexcept { return found_[static_cast<std::size_t>(i)].vertex; }

 private:
  struct Found {
    double distance = 0.0;
    int vertex = -1;
  };
  void add(int v, double radius) noexcept {
    const double distance = (surface_.position(v) - middle_).norm();
    if (!(distance <= radius) || count_ == Grasp::most_visited) return;
    for (int i = 0; i < count_; ++i)
      if (vertex(i) == v) return;
    found_[static_cast<std::size_t>(count_++)] = {distance, v};
  }

  const ContactSurface& surface_;
  Vector3 middle_;
  std::array<Found, Grasp::most_visited> found_{};
  int count_ = 0;
};

}  // namespace detail

PALPATE_INLINE bool Grasp::holds(const ContactSurface& surface, const detail::Candidates& candidates,
                                 const detail::Candidate& c) const noexcept {
  if (count_ == 0) return false;
  const detail::ContactSample& sample = candidates.sample_of(c);
  const auto grasped = [&](int vertex) {
    return std::find(vertices_.begin(), vertices_.begin() + count_, vertex) != vertices_.begin() + count_;
  };
  if (vertices_[0] < 0) {
    if (c.sample == rows_[0].sample) return true;
    if (!candidates.half_space_point(rows_[0].sample).is_known()) return false;
    const Vector3 middle = detail::Candidates::rest(surface, candidates.sample_of(rows_[0]));
    return (detail::Candidates::rest(surface, sample) - middle).squaredNorm() < rows_[0].area * std::numbers::inv_pi;
  }
  double moved = 0.0;
  for (std::size_t a = 0; a < 3; ++a)
    if (sample.weights[a] > 0.0 && grasped(sample.vertices[a])) moved += sample.weights[a];
  return moved > 0.5;
}

PALPATE_INLINE void Grasp::grasp_point(const detail::Candidate& point, const ContactTool& tool) noexcept {
  vertices_[static_cast<std::size_t>(count_)] = -1;
  for (int k = 0; k < 3; ++k) {
    detail::Candidate& c = rows_[static_cast<std::size_t>(3 * count_ + k)] = point;
    c.lift();
    c.grasped = true;
    c.normal = Vector3(k == 0, k == 1, k == 2);
    c.anchor = tool.rotation.transpose() * (c.point - tool.proxy);
  }
  ++count_;
}

PALPATE_INLINE void Grasp::grasp_pad(const ContactSurface& surface, const detail::Candidates& candidates,
                                     const detail::Candidate& point, const ContactTool& tool, double radius,
                                     int most) noexcept {
  const detail::ContactSample& middle = candidates.sample_of(point);
  const Vector3 rest = detail::Candidates::rest(surface, middle);
  is_coarse_ = false;
  for (const int v : middle.vertices) is_coarse_ = is_coarse_ || (surface.position(v) - rest).norm() > radius;
  const detail::PadSearch search(surface, middle.vertices, rest, radius);
  const int points = std::min({search.count(), most, most_points});
  for (int i = 0; i < points; ++i) {
    detail::Candidate c = point;
    c.sample = candidates.samples().of_vertex(surface, search.vertex(i));
    if (c.sample < 0) continue;
    c.triangle = surface.triangles_at(search.vertex(i)).front();
    c.row = c.slot = -1;
    c.history = {};
    c.generation = 0;
    grasp_point(c, tool);
    vertices_[static_cast<std::size_t>(count_ - 1)] = search.vertex(i);
  }
}

PALPATE_INLINE void Grasp::place_pad(const TissueView& tissue, detail::Candidates& candidates,
                                     detail::SurfaceDisplacement& displacement, const ContactTool& tool) noexcept {
  for (detail::Candidate& c : rows()) {
    const Vector3 axis = c.normal;
    candidates.evaluate(tissue, tool, displacement, c);
    c.normal = axis;
    c.anchor = tool.rotation.transpose() * (c.point - tool.proxy);
  }
}

PALPATE_INLINE void Grasp::release() noexcept {
  requested = is_coarse_ = false;
  count_ = 0;
}

PALPATE_INLINE void Grasp::move_to(const detail::Candidates& candidates, const detail::ContactSamples& before,
                                   const ContactSurface& surface) noexcept {
  int kept = 0;
  for (int i = 0; i < count_; ++i) {
    bool exists = true;
    for (int k = 0; k < 3; ++k) {
      detail::Candidate& c = rows_[static_cast<std::size_t>(3 * kept + k)] = rows_[static_cast<std::size_t>(3 * i + k)];
      exists = candidates.move(c, before, surface) && exists;
    }
    vertices_[static_cast<std::size_t>(kept)] = vertices_[static_cast<std::size_t>(i)];
    if (exists) ++kept;
  }
  count_ = kept;
}

}}  // namespace palpate
