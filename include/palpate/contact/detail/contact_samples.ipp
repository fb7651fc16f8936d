// Definitions of contact_samples.hpp.
#pragma once

#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/contact/subfacet_compliance.hpp>
#include <palpate/core/setup_error.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <map>
#include <numbers>
#include <numeric>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Sum of the absolute differences of the weights.
inline double difference(const ContactSample& a, const ContactSample& b) noexcept {
  double sum = 2.0;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j)
      if (a.vertices[i] == b.vertices[j]) sum -= 2.0 * std::min(a.weights[i], b.weights[j]);
  return sum;
}

/// An edge of a whole number of spacings has one part more, as if it were longer, whether rounding made it so or not:
/// coordinates in float are rounded by 1e-7. A rotated or scaled copy of the surface then has the same points.
inline int subdivision(double length, double spacing) {
  const double parts = std::ceil((1.0 + ContactSamples::rounding) * length / spacing);
  return static_cast<int>(std::clamp(parts, 1.0, static_cast<double>(ContactSamples::maximum_subdivision)));
}

/// Length of an edge without loads; infinity if not known.
inline double unloaded_length(const ContactSurface& surface, std::int64_t a, std::int64_t b) {
  const std::vector<Vector3>& x = surface.unloaded().positions;
  if (x.size() != surface.positions().size()) return infinity;
  return (x[static_cast<std::size_t>(a)] - x[static_cast<std::size_t>(b)]).norm();
}

/// Places the samples, chooses those of every level and divides the surface among them.
class ContactSamples::Builder {
 public:
  Builder(ContactSamples& made, const ContactSurface& surface) : made_(made), surface_(surface) {}

  void place() {
    std::vector<bool> taken(static_cast<std::size_t>(surface_.vertex_count()), false);
    sample_of_vertex_.resize(taken.size(), -1);
    made_.first_.assign(1, 0);
    for (int t = 0; t < static_cast<int>(surface_.triangles().size()); ++t) {
      add_triangle(t);
      made_.first_.push_back(made_.count());
    }
    points_.resize(made_.samples_.size());
    for (int t = 0; t < static_cast<int>(surface_.triangles().size()); ++t) add_areas(t);
    for (std::size_t i = 0; i < points_.size(); ++i) {
      Point& p = points_[i];
      const ContactSample& s = made_.samples_[i];
      for (std::size_t a = 0; a < 3; ++a) p.position += s.weights[a] * at_rest(s.vertices[a]);
      if (const double length = p.normal.norm(); length > 0.0) p.normal /= length;
      p.key = key_of(s);
    }
  }

  /// The spacing of level 0 is that of the mesh where that is finer.
  void measure_spacing() {
    constexpr double part = 0.02;  // of the points are closer
    std::vector<double> areas;
    for (const Point& p : points_) areas.push_back(p.area);
    if (areas.empty()) return;
    const auto at_part = areas.begin() + static_cast<std::ptrdiff_t>(part * static_cast<double>(areas.size()));
    std::nth_element(areas.begin(), at_part, areas.end());
    if (*at_part > 0.0) made_.finest_ = std::min(made_.finest_, std::sqrt(*at_part * 2.0 / std::numbers::sqrt3));
  }

  /// Coarse levels first: their points keep the largest distances. The order is random, so that no direction is
  /// preferred, but the same in every run.
  void choose_levels() {
    std::vector<std::pair<std::uint64_t, int>> order;
    for (int i = 0; i < made_.count(); ++i) order.emplace_back(points_[at(i)].key, i);
    std::sort(order.begin(), order.end());
    std::vector<Point> points;  // in this order: read one after the other, once per level
    for (const auto& [key, i] : order) points.push_back(points_[at(i)]);
    std::vector<std::uint8_t> levels(points.size(), 0);
    std::vector<int> taken;
    for (int level = made_.levels_ - 1; level > 0; --level) {
      Cells cells(points, least_distance * made_.spacing(level));
      for (const int k : taken) cells.add(k);
      for (int k = 0; k < made_.count(); ++k) {
        if (levels[at(k)] > 0 || cells.has_near(points[at(k)])) continue;
        levels[at(k)] = static_cast<std::uint8_t>(level);
        cells.add(k);
        taken.push_back(k);
      }
    }
    made_.level_.resize(levels.size());
    for (std::size_t k = 0; k < order.size(); ++k) made_.level_[at(order[k].second)] = levels[k];
  }

  void divide_areas() {
    made_.first_area_.assign(1, 0);
    for (const std::uint8_t level : made_.level_) made_.first_area_.push_back(made_.first_area_.back() + level + 1);
    made_.area_.assign(at(made_.first_area_.back()), 0.0f);
    for (int level = 0; level < made_.levels_; ++level) {
      Cells cells(points_, least_distance * made_.spacing(level));
      for (int i = 0; level > 0 && i < made_.count(); ++i)
        if (made_.level_of(i) >= level) cells.add(i);
      for (int i = 0; i < made_.count(); ++i) {
        const int owner = made_.level_of(i) >= level ? i : cells.nearest(points_[at(i)]);
        if (owner >= 0)
          made_.area_[at(made_.first_area_[at(owner)] + level)] += static_cast<float>(points_[at(i)].area);
      }
    }
  }

  /// Within every triangle the samples of the last levels come first: a search for those of one level ends early.
  void sort() {
    std::vector<int> order(points_.size());
    std::iota(order.begin(), order.end(), 0);
    for (std::size_t t = 0; t + 1 < made_.first_.size(); ++t)
      std::stable_sort(order.begin() + made_.first_[t], order.begin() + made_.first_[t + 1],
                       [&](int i, int j) { return made_.level_of(i) > made_.level_of(j); });
    ContactSamples sorted;
    sorted.first_area_.assign(1, 0);
    for (const int i : order) {
      sorted.samples_.push_back(made_[i]);
      sorted.normal_.push_back(points_[at(i)].normal.cast<float>());
      sorted.level_.push_back(made_.level_[at(i)]);
      for (int k = 0; k <= made_.level_of(i); ++k)
        sorted.area_.push_back(made_.area_[at(made_.first_area_[at(i)] + k)]);
      sorted.first_area_.push_back(static_cast<int>(sorted.area_.size()));
    }
    sorted.first_ = std::move(made_.first_);
    sorted.finest_ = made_.finest_;
    sorted.levels_ = made_.levels_;
    made_ = std::move(sorted);
  }

 private:
  /// Points of a level are at least this far apart, in spacings; they then have about the density of the level.
  static constexpr double least_distance = 0.72;

  struct Point {
    Vector3 position = Vector3::Zero(), normal = Vector3::Zero();
    double area = 0.0;  // of level 0
    std::uint64_t key = 0;
  };

  /// Points in cells of a grid, in a hash table with chains. Points with normals more than 60 degrees apart are not
  /// neighbours: they are on two sides of a thin part, or of an edge.
  class Cells {
   public:
    /// For points that are closer than `distance`: with cells of twice that they are in eight of them.
    Cells(const std::vector<Point>& points, double distance)
        : points_(points),
          squared_(distance * distance),
          per_size_(0.5 / distance),
          head_(std::bit_ceil(2 * points.size() + 64), -1),
          next_(points.size(), -1) {}
    void add(int i) {
      const Vector3& x = points_[at(i)].position;
      int& head = head_[slot(cell(x[0]), cell(x[1]), cell(x[2]))];
      next_[at(i)] = std::exchange(head, i);
    }
    bool has_near(const Point& p) const noexcept {
      return visit(p, [this, &p](int i) { return squared_distance(p, i) < squared_; });
    }
    /// The nearest point that is closer than the distance; -1 when none is. Lattices have many points between two that
    /// are equally far: of these the one with the smaller key, so that rounding does not choose.
    int nearest(const Point& p) const noexcept {
      int best = -1;
      double least = squared_;
      visit(p, [&](int i) {
        const double squared = squared_distance(p, i);
        const bool is_equal = best >= 0 && std::abs(squared - least) <= rounding * least;
        if (is_equal ? points_[at(i)].key < points_[at(best)].key : squared < least) least = squared, best = i;
        return false;
      });
      return best;
    }

   private:
    std::int64_t cell(double x) const noexcept { return static_cast<std::int64_t>(std::floor(x * per_size_)); }
    /// Cells of a block of 4 x 4 x 4 are beside each other in memory: the eight cells of a search are in few blocks.
    std::size_t slot(std::int64_t x, std::int64_t y, std::int64_t z) const noexcept {
      std::uint64_t key = static_cast<std::uint64_t>(x >> 2) * 0x9e3779b97f4a7c15u;
      key = (key ^ static_cast<std::uint64_t>(y >> 2)) * 0x9e3779b97f4a7c15u;
      key = (key ^ static_cast<std::uint64_t>(z >> 2)) * 0x9e3779b97f4a7c15u;
      const auto inside = static_cast<std::uint64_t>((x & 3) | (y & 3) << 2 | (z & 3) << 4);
      return static_cast<std::size_t>(((key ^ key >> 32) << 6 | inside) & (head_.size() - 1));
    }
    /// Infinite for points that are not neighbours.
    double squared_distance(const Point& p, int i) const noexcept {
      const Point& other = points_[at(i)];
      if (!(other.normal.dot(p.normal) > 0.5)) return infinity;
      return (other.position - p.position).squaredNorm();
    }
    /// Calls `visitor` with the points of the eight cells until it returns true; whether it did.
    template <typename Visitor>
    bool visit(const Point& p, Visitor&& visitor) const noexcept {
      std::array<std::int64_t, 3> first;
      for (std::size_t c = 0; c < 3; ++c)
        first[c] = static_cast<std::int64_t>(std::floor(p.position[static_cast<Index>(c)] * per_size_ - 0.5));
      for (int k = 0; k < 8; ++k)
        for (int i = head_[slot(first[0] + (k & 1), first[1] + (k >> 1 & 1), first[2] + (k >> 2))]; i >= 0;
             i = next_[at(i)])
          if (visitor(i)) return true;
      return false;
    }
    const std::vector<Point>& points_;
    double squared_, per_size_;
    std::vector<int> head_, next_;
  };

  /// A bijection of 64 bits without order (Steele, Lea and Flood 2014).
  static std::uint64_t mixed(std::uint64_t i) noexcept {
    std::uint64_t z = i + 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
  }

  /// Where the half-space is known, places are in its frame, which no load moves.
  const Vector3& at_rest(int v) const noexcept {
    const SubfacetCompliance* const known = surface_.subfacet().get();
    return known != nullptr && known->has_place(v) ? known->vertex(v).position : surface_.position(v);
  }
  /// A number that a point keeps when other triangles are cut.
  std::uint64_t key_of(const ContactSample& s) const noexcept {
    std::uint64_t key = 0;
    for (std::size_t a = 0; a < 3; ++a) {  // in any order
      if (s.weights[a] == 0.0) continue;
      const auto vertex = static_cast<std::uint64_t>(s.vertices[a]);
      key += mixed(vertex << 32 ^ static_cast<std::uint64_t>(std::llround(s.weights[a] * 0x1p24)));
    }
    return mixed(key);
  }
  double length(int a, int b) const noexcept { return (surface_.position(a) - surface_.position(b)).norm(); }
  int parts(const Triangle& t) const noexcept {
    return subdivision(std::max({length(t[0], t[1]), length(t[1], t[2]), length(t[2], t[0])}), made_.finest_);
  }

  void add_triangle(int number) {
    const Triangle& t = surface_.triangle(number);
    for (std::size_t i = 0; i < 3; ++i) {
      int& sample = sample_of_vertex_[at(t[i])];
      if (sample >= 0) continue;
      sample = made_.count();
      made_.samples_.push_back({{t[i], t[(i + 1) % 3], t[(i + 2) % 3]}, {1.0, 0.0, 0.0}});
    }
    for (std::size_t i = 0; i < 3; ++i) add_edge(t[i], t[(i + 1) % 3], t[(i + 2) % 3]);
    const int n = parts(t);
    for (int a = 1; a < n - 1; ++a)
      for (int b = 1; b < n - a; ++b)
        made_.samples_.push_back(
            {t, {static_cast<double>(a) / n, static_cast<double>(b) / n, static_cast<double>(n - a - b) / n}});
  }

  static std::pair<int, int> edge(int a, int b) noexcept { return std::minmax(a, b); }

  void add_edge(int a, int b, int c) {
    const auto [place, is_new] = edges_.try_emplace(edge(a, b), Edge{a, made_.count(), 0});
    if (!is_new) return;
    const int n = place->second.parts = subdivision(length(a, b), made_.finest_);
    for (int k = 1; k < n; ++k)
      made_.samples_.push_back({{a, b, c}, {1.0 - static_cast<double>(k) / n, static_cast<double>(k) / n, 0.0}});
  }

  void give(int sample, double area, const Vector3& normal) {
    points_[at(sample)].area += area;
    points_[at(sample)].normal += area * normal;
  }

  /// A place on an edge from a to b: its area goes to the two samples of the edge beside it.
  void give_to_edge(int a, int b, double part, double area, const Vector3& normal) {
    const Edge& e = edges_.at(edge(a, b));
    const double place = (e.from == a ? part : 1.0 - part) * e.parts;
    const int k = std::clamp(static_cast<int>(place), 0, e.parts - 1);
    const auto sample = [&](int i) {
      if (i == 0) return sample_of_vertex_[at(e.from)];
      return i == e.parts ? sample_of_vertex_[at(e.from == a ? b : a)] : e.first + i - 1;
    };
    give(sample(k), (1.0 - (place - k)) * area, normal);
    give(sample(k + 1), (place - k) * area, normal);
  }

  /// Every small triangle of the lattice gives a third of its area to each corner.
  void add_areas(int number) {
    const Triangle& t = surface_.triangle(number);
    const Vector3 x = at_rest(t[0]);
    const Vector3 normal = cross(at_rest(t[1]) - x, at_rest(t[2]) - x);
    const double area = 0.5 * normal.norm();
    if (!(area > 0.0)) return;
    const Vector3 unit = normal.normalized();
    const int n = parts(t);
    const double third = area / (3.0 * n * n);
    int inner = made_.first_[at(number) + 1] - (n - 1) * (n - 2) / 2;
    for (std::size_t i = 0; i < 3; ++i) {
      give(sample_of_vertex_[at(t[i])], third, unit);
      for (int k = 1; k < n; ++k) give_to_edge(t[i], t[(i + 1) % 3], static_cast<double>(k) / n, 3.0 * third, unit);
    }
    for (; inner < made_.first_[at(number) + 1]; ++inner) give(inner, 6.0 * third, unit);
  }

  struct Edge {
    int from, first, parts;  // where its samples begin, the first of them, parts
  };

  ContactSamples& made_;
  const ContactSurface& surface_;
  std::vector<Point> points_;
  std::vector<int> sample_of_vertex_;
  std::map<std::pair<int, int>, Edge> edges_;
};

PALPATE_INLINE ContactSamples::ContactSamples(const ContactSurface& surface, double finest, double coarsest)
    : finest_(finest) {
  constexpr int most_levels = 40;
  Builder builder(*this, surface);
  builder.place();
  builder.measure_spacing();
  levels_ = std::clamp(static_cast<int>(std::ceil(2.0 * std::log2(std::max(coarsest, finest) / finest_) - rounding)), 0,
                       most_levels) +
            1;
  builder.choose_levels();
  builder.divide_areas();
  builder.sort();
}

PALPATE_INLINE double ContactSamples::level_with(double spacing) const noexcept {
  return std::clamp(2.0 * std::log2(spacing / finest_), 0.0, static_cast<double>(levels_ - 1));
}

PALPATE_INLINE double ContactSamples::area(int sample, double level) const noexcept {
  const int low = std::min(static_cast<int>(level), levels_ - 1), last = level_of(sample);
  const float* const own = area_.data() + first_area_[at(sample)];
  const double part = level - low, here = low <= last ? static_cast<double>(own[low]) : 0.0;
  return part > 0.0 ? (1.0 - part) * here + (low < last ? part * static_cast<double>(own[low + 1]) : 0.0) : here;
}

PALPATE_INLINE int ContactSamples::nearest(const ContactSurface& surface, const ContactSample& wanted,
                                           int level) const noexcept {
  int best = -1;
  // A cut body that is restored has fewer vertices.
  if (wanted.vertices[0] >= surface.vertex_count()) return best;
  double least = 1.0;  // with half of the weight on other vertices it is a different place
  for (const int t : surface.triangles_at(wanted.vertices[0]))
    for (int s = first_of(t); s < first_of(t + 1) && level_of(s) >= level; ++s)
      if (const double off = difference((*this)[s], wanted); off < least) least = off, best = s;
  return best;
}

PALPATE_INLINE int ContactSamples::of_vertex(const ContactSurface& surface, int vertex) const noexcept {
  for (const int t : surface.triangles_at(vertex))
    for (int s = first_of(t); s < first_of(t + 1); ++s)
      if ((*this)[s].vertices[0] == vertex && (*this)[s].weights[0] == 1.0) return s;
  return -1;
}

PALPATE_INLINE void require_dense_points(const ContactSurface& surface, double radius) {
  const double most = ContactSamples::maximum_subdivision * radius;
  SetupProblem problem;
  problem.value = problem.threshold = most;
  for (const Triangle& t : surface.triangles())
    for (std::size_t i = 0; i < 3; ++i) {
      const int a = t[i], b = t[(i + 1) % 3];
      const double length = (surface.position(a) - surface.position(b)).norm();
      if (!(length > problem.value)) continue;
      problem.value = length;
      problem.ids = {a, b};
    }
  if (problem.ids.empty()) return;
  problem.count = 2;
  const std::string bound = ", more than " + std::to_string(ContactSamples::maximum_subdivision) +
                            " radii of the smallest tool (" + number(radius) +
                            " m): it would fall through; the ids are vertices of the surface";
  const double unloaded = unloaded_length(surface, problem.ids[0], problem.ids[1]);
  if (unloaded <= most) {
    problem.what = "the scene's loads (" + surface.unloaded().loads +
                   ") stretch an edge of the touchable surface from " + number(unloaded) + " m to " +
                   number(problem.value) + " m" + bound;
    problem.hint =
        "Loads should not deform the body that much: check stiffness (Pa), density (kg/m^3), the unit of length of the "
        "mesh (m) and the supports of the body";
  } else {
    problem.what = "an edge of the touchable surface is " + number(problem.value) + " m long" + bound;
    problem.hint = "Refine the mesh where tools touch, or use a larger tool";
  }
  raise(std::move(problem));
}

}}}  // namespace palpate::detail
