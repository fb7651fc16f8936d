// Positions of contact points and the triangles they belong to.
#include <palpate/contact/contact_problem.hpp>
#include <palpate/mesh/generators.hpp>
#include <palpate/testing/random.hpp>

#include <Eigen/Geometry>

#include <cmath>
#include <set>
#include <tuple>

#include "catch.hpp"
#include "refused.hpp"

using namespace palpate;

namespace {

ContactSurface surface_to_sample(const Mesh<Tet4>& mesh) {
  std::vector<Triangle> triangles;
  for (const auto& face : extract_boundary<Tet4>(mesh))
    triangles.push_back({face.nodes[0], face.nodes[1], face.nodes[2]});
  return {mesh.positions, triangles};
}

Vector3 position(const ContactSurface& surface, const detail::ContactSample& s) {
  Vector3 x = Vector3::Zero();
  for (std::size_t a = 0; a < 3; ++a) x += s.weights[a] * surface.position(s.vertices[a]);
  return x;
}

std::vector<detail::ContactSample> of_triangle(const detail::ContactSamples& samples, int t) {
  std::vector<detail::ContactSample> own;
  for (int i = samples.first_of(t); i < samples.first_of(t + 1); ++i) own.push_back(samples[i]);
  return own;
}

std::vector<Vector3> all_positions(const ContactSurface& surface, const detail::ContactSamples& samples) {
  std::vector<Vector3> all;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t)
    for (const detail::ContactSample& s : of_triangle(samples, t)) all.push_back(position(surface, s));
  return all;
}

}  // namespace

TEST_CASE("short edges are sampled at their vertices only", "[contact][samples]") {
  const ContactSurface surface = surface_to_sample(box_tet4(Vector3(1, 1, 1), {4, 4, 4}, BoxSplit::six));
  const detail::ContactSamples samples(surface, 0.36);  // diagonals are 0.354
  CHECK(samples.count() == 5 * 5 * 5 - 3 * 3 * 3);
}

TEST_CASE("the lattice of a right triangle is that of its longest edge; each edge has its own", "[contact][samples]") {
  const ContactSurface one({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {{0, 1, 2}});
  for (int n : {1, 2, 3, 7}) {
    const int diagonal = static_cast<int>(std::ceil(std::sqrt(2.0) * n - 1e-9));
    const detail::ContactSamples samples(one, 1.001 / n);
    CHECK(samples.count() == 3 + 2 * (n - 1) + (diagonal - 1) + (diagonal - 1) * (diagonal - 2) / 2);
    CHECK(of_triangle(samples, 0).size() == static_cast<std::size_t>(samples.count()));
  }
}

TEST_CASE("an edge of a whole number of spacings has the same points in any rounding", "[contact][samples]") {
  // Lengths and spacings that differ from an exact ratio in the last bits, as in scaled and rotated copies.
  testing::Random random(17);
  for (const int parts : {2, 3, 8}) {
    const double scale = random.uniform(1e-3, 1e3);
    for (int i = -4; i <= 4; ++i) {
      const double side = scale * (1.0 + i * 0x1p-52);
      const ContactSurface one({{0, 0, 0}, {side, 0, 0}, {0, side, 0}}, {{0, 1, 2}});
      CHECK(detail::ContactSamples(one, scale / parts).count() ==
            detail::ContactSamples(ContactSurface({{0, 0, 0}, {1.01, 0, 0}, {0, 1.01, 0}}, {{0, 1, 2}}), 1.0 / parts)
                .count());
    }
  }
}

TEST_CASE("every sample belongs to one triangle, with barycentric weights", "[contact][samples]") {
  const ContactSurface surface = surface_to_sample(box_tet4(Vector3(1, 1, 0.5), {3, 2, 2}, BoxSplit::five_mirrored));
  const detail::ContactSamples samples(surface, 0.1);
  std::set<std::tuple<long, long, long>> places;
  int bad_weights = 0, foreign = 0, total = 0;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t)
    for (const detail::ContactSample& s : of_triangle(samples, t)) {
      ++total;
      double sum = 0.0;
      for (double w : s.weights) {
        if (!(w >= 0.0 && w <= 1.0)) ++bad_weights;
        sum += w;
      }
      if (std::abs(sum - 1.0) > 1e-14) ++bad_weights;
      Triangle mine = s.vertices, whole = surface.triangle(t);
      std::ranges::sort(mine);
      std::ranges::sort(whole);
      if (mine != whole) ++foreign;
      const Vector3 x = 1e9 * position(surface, s);
      places.emplace(std::lround(x[0]), std::lround(x[1]), std::lround(x[2]));
    }
  CHECK(bad_weights == 0);
  CHECK(foreign == 0);
  CHECK(total == samples.count());
  CHECK(places.size() == static_cast<std::size_t>(samples.count()));  // none twice
}

TEST_CASE("no point of the surface is further than the spacing from a sample", "[contact][samples]") {
  testing::Random random(41);
  for (double spacing : {0.05, 0.13, 0.3, 1.0}) {
    // Long thin triangles as well: 0.5 x 0.1 cells.
    const ContactSurface surface = surface_to_sample(box_tet4(Vector3(1, 1, 0.5), {2, 10, 3}, BoxSplit::six));
    const detail::ContactSamples samples(surface, spacing);
    const std::vector<Vector3> places = all_positions(surface, samples);
    double farthest = 0.0;
    for (int i = 0; i < 3000; ++i) {
      const Triangle& t = surface.triangle(static_cast<int>(random.bits() % surface.triangles().size()));
      double u = random.uniform(), v = random.uniform();
      if (u + v > 1.0) {
        u = 1.0 - u;
        v = 1.0 - v;
      }
      const Vector3 p =
          (1.0 - u - v) * surface.position(t[0]) + u * surface.position(t[1]) + v * surface.position(t[2]);
      double nearest = infinity;
      for (const Vector3& x : places) nearest = std::min(nearest, (x - p).norm());
      farthest = std::max(farthest, nearest);
    }
    INFO("spacing " << spacing);
    CHECK(farthest <= spacing);
  }
}

TEST_CASE("samples on a line of the mesh are not further apart than the spacing", "[contact][samples]") {
  const ContactSurface one({{0, 0, 0}, {1, 0, 0}, {0.2, 0.7, 0.1}}, {{0, 1, 2}});
  for (double spacing : {0.07, 0.2, 0.4, 0.6}) {
    const detail::ContactSamples samples(one, spacing);
    for (std::size_t i = 0; i < 3; ++i) {
      std::vector<double> along;
      for (const detail::ContactSample& s : of_triangle(samples, 0)) {
        std::array<double, 3> w{};
        for (std::size_t a = 0; a < 3; ++a) w[static_cast<std::size_t>(s.vertices[a])] = s.weights[a];
        if (w[i] == 0.0) along.push_back(w[(i + 1) % 3]);
      }
      std::ranges::sort(along);
      REQUIRE(along.size() >= 2);
      CHECK(along.front() == 0.0);
      CHECK(along.back() == 1.0);
      const double length =
          (one.position(static_cast<int>((i + 1) % 3)) - one.position(static_cast<int>((i + 2) % 3))).norm();
      for (std::size_t k = 1; k < along.size(); ++k)
        CHECK((along[k] - along[k - 1]) * length <= spacing * (1.0 + 1e-12));
    }
  }
}

TEST_CASE("a surface so coarse that a sphere would fall between its points is refused", "[contact][samples][extreme]") {
  const auto sample = [](double edge, double radius) {
    const ContactSurface surface({{0, 0, 0}, {edge, 0, 0}, {0, edge / 2, 0}, {0, 0, edge / 4}}, {{0, 1, 2}, {0, 2, 3}});
    ContactProblem(surface, radius, {.capacity = 8});
  };
  sample(0.1, 1.01 * std::hypot(0.1, 0.05) / 32);
  const SetupProblem refused = test::refusal([&] { sample(0.1, 1e-3); });
  CHECK(refused.kind == SetupErrorKind::bad_argument);
  CHECK(refused.ids == std::vector<std::int64_t>{1, 2});
  CHECK(refused.count == 2);
  CHECK(std::abs(refused.value - std::hypot(0.1, 0.05)) < 1e-15);
  CHECK(std::abs(refused.threshold - 0.032) < 1e-15);
  CHECK(!refused.hint.empty());
}

TEST_CASE("the lattice of a huge triangle is bounded", "[contact][samples][extreme]") {
  const ContactSurface huge({{0, 0, 0}, {1e6, 0, 0}, {0, 1e6, 0}}, {{0, 1, 2}});
  CHECK(detail::ContactSamples(huge, 1e-3).count() == 33 * 34 / 2);
  CHECK(detail::ContactSamples(huge, 1e-300).count() == 33 * 34 / 2);
  CHECK(detail::ContactSamples(huge, 1e308).count() == 3);
  CHECK(detail::ContactSamples(ContactSurface(), 1.0).count() == 0);
}

TEST_CASE("every level divides the whole surface among points that are spread evenly", "[contact][samples][levels]") {
  const auto split = GENERATE(BoxSplit::six, BoxSplit::five_mirrored);
  const auto [cells, finest] = GENERATE(std::pair{2, 0.04}, std::pair{9, 0.04}, std::pair{40, 0.03});
  const ContactSurface surface = surface_to_sample(box_tet4(Vector3(1, 1, 0.5), {cells, cells, cells / 2}, split));
  const detail::ContactSamples samples(surface, finest, 0.2);
  double area = 0.0;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t)
    area += 0.5 * surface.facet_length(t) * surface.facet_length(t);
  REQUIRE(samples.levels() >= 5);
  for (double level = 0.0; level <= samples.levels() - 1; level += 0.5) {
    double sum = 0.0;
    for (int s = 0; s < samples.count(); ++s) sum += samples.area(s, level);
    CAPTURE(cells, level);
    CHECK_THAT(sum, Catch::Matchers::WithinRel(area, 1e-5));
  }
  std::vector<Vector3> place, normal;
  for (int s = 0; s < samples.count(); ++s) {
    place.push_back(position(surface, samples[s]));
    normal.push_back(samples.normal(s));
  }
  for (int level = 1; level < samples.levels(); ++level) {
    int count = 0;
    double nearest = infinity;
    for (int s = 0; s < samples.count(); ++s) {
      if (samples.level_of(s) < level) continue;
      ++count;
      for (int r = 0; r < s; ++r)
        if (samples.level_of(r) >= level &&
            normal[static_cast<std::size_t>(r)].dot(normal[static_cast<std::size_t>(s)]) > 0.5)
          nearest = std::min(nearest, (place[static_cast<std::size_t>(r)] - place[static_cast<std::size_t>(s)]).norm());
    }
    CAPTURE(cells, level, count);
    CHECK(nearest >= 0.7 * samples.spacing(level));
    const double hexagons = area / (0.5 * std::sqrt(3.0) * samples.spacing(level) * samples.spacing(level));
    CHECK(count <= 1.5 * hexagons);
    if (samples.spacing(level) > 2.0 / cells) CHECK(count >= 0.6 * hexagons);  // else the mesh has few vertices
  }
}

TEST_CASE("a rotated, moved and scaled copy has the same levels and areas", "[contact][samples][levels]") {
  // Lattices have many points that are equally far from two of a level: rounding must not choose between these.
  const auto split = GENERATE(BoxSplit::six, BoxSplit::five_mirrored);
  const Mesh<Tet4> mesh = box_tet4(Vector3(1, 1, 0.5), {5, 5, 3}, split);
  Mesh<Tet4> copy = mesh;
  const double scale = 1.7;
  for (Vector3& x : copy.positions)
    x = scale * (Eigen::AngleAxisd(0.7, Vector3(1, 2, 3).normalized()) * x) + Vector3(0.3, -0.2, 0.1);
  const detail::ContactSamples samples(surface_to_sample(mesh), 0.03, 0.3),
      copies(surface_to_sample(copy), 0.03 * scale, 0.3 * scale);
  REQUIRE(samples.count() == copies.count());
  REQUIRE(samples.levels() == copies.levels());
  int other_level = 0;
  double largest = 0.0;
  for (int s = 0; s < samples.count(); ++s) {
    other_level += samples.level_of(s) != copies.level_of(s);
    for (int level = 0; level <= samples.level_of(s); ++level)
      largest = std::max(largest, std::abs(copies.area(s, level) / (scale * scale * samples.area(s, level)) - 1.0));
  }
  CHECK(other_level == 0);
  CHECK(largest < 1e-5);  // areas are float
}

TEST_CASE("the samples of a triangle begin with those of the last levels", "[contact][samples][levels]") {
  const ContactSurface surface = surface_to_sample(box_tet4(Vector3(1, 1, 0.5), {3, 3, 2}, BoxSplit::six));
  const detail::ContactSamples samples(surface, 0.04, 0.3);
  int wrong = 0, fading = 0;
  for (int t = 0; t < static_cast<int>(surface.triangles().size()); ++t)
    for (int s = samples.first_of(t) + 1; s < samples.first_of(t + 1); ++s)
      wrong += samples.level_of(s) > samples.level_of(s - 1);
  for (int s = 0; s < samples.count(); ++s) {
    const int last = samples.level_of(s);
    if (last + 1 == samples.levels()) continue;
    ++fading;
    wrong += !(samples.area(s, last) > 0.0) || samples.area(s, last + 1) != 0.0 ||
             !(samples.area(s, last + 0.9) < 0.11 * samples.area(s, last));
  }
  CHECK(wrong == 0);
  CHECK(fading > 0);
}
