// The compliance between contact points and when it is read again.
#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/contact/detail/row_compliance.hpp>
#include <palpate/testing/random.hpp>

#include "catch.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

using namespace palpate;

namespace {

/// A strip of triangles between vertices whose compliance is any function of the pair; counts how often it is read.
struct CountingTissue : StillTissue {
  ContactSurface surface;
  std::uint64_t revision = 0;
  double scale = 1.0;
  mutable int reads = 0;

  CountingTissue() {
    std::vector<Vector3> x;
    std::vector<Triangle> t;
    for (int i = 0; i < 12; ++i) x.emplace_back(0.01 * i, 0.01 * (i % 2), 0.0);
    for (int i = 0; i + 2 < 12; ++i) t.push_back(i % 2 == 0 ? Triangle{i, i + 2, i + 1} : Triangle{i, i + 1, i + 2});
    surface = ContactSurface(std::move(x), std::move(t));
  }
  const ContactSurface& contact_surface() const noexcept { return surface; }
  Status require_columns(std::span<const int>) noexcept { return {}; }
  Matrix3 compliance(int i, int j) const noexcept {
    ++reads;
    return value(i, j);
  }
  /// C(i, j) = C(j, i)^T, with no other symmetry.
  Matrix3 value(int i, int j) const noexcept {
    if (i > j) return value(j, i).transpose();
    Matrix3 m;
    for (int k = 0; k < 9; ++k) m.data()[k] = scale * std::sin(1.0 + 3.1 * i + 7.7 * j + 0.9 * k);
    return i == j ? Matrix3(0.5 * (m + m.transpose())) : m;
  }
  std::uint64_t compliance_revision() const noexcept { return revision; }
  double compliance_bound(int) const noexcept { return 3.0 * scale; }
  double compliance_floor() const noexcept { return 1e-12; }
  const Eigen::Isometry3d& to_world() const noexcept {
    static const Eigen::Isometry3d identity = Eigen::Isometry3d::Identity();
    return identity;
  }
};
static_assert(TissueModel<CountingTissue>);

/// The same, whose surface turns and stretches with every revision.
struct StretchedTissue : CountingTissue {
  Matrix3 half_space_map(int v) const noexcept {
    const auto state = static_cast<double>(revision);
    return Matrix3(Eigen::AngleAxisd(0.3 * state + 0.05 * v, Vector3(1.0, 2.0, 3.0).normalized())) /
           (1.0 + 0.2 * state);
  }
};
static_assert(TissueModel<StretchedTissue>);

/// Every vertex known, and shown by itself and both neighbours.
std::shared_ptr<const SubfacetCompliance> subfacet_of(const ContactSurface& surface) {
  std::vector<detail::HalfSpacePoint> vertices;
  std::vector<SubfacetCompliance::Block> blocks;
  std::vector<int> first{0};
  for (int v = 0; v < surface.vertex_count(); ++v) {
    vertices.push_back({.position = surface.position(v),
                        .normal = Vector3(0.0, 0.0, 1.0),
                        .root = detail::HalfSpacePoint::root_of(2e3),
                        .poisson_ratio = 0.4,
                        .length = 0.01});
    for (int other = std::max(0, v - 1); other < std::min(surface.vertex_count(), v + 2); ++other)
      blocks.push_back({other, 0.01 / (1.0 + std::abs(v - other)) * Matrix3::Identity()});
    first.push_back(static_cast<int>(blocks.size()));
  }
  return std::make_shared<SubfacetCompliance>(std::move(vertices), std::move(first), std::move(blocks));
}

Matrix3 expected(const CountingTissue& tissue, const detail::ContactSample& p, const detail::ContactSample& q) {
  Matrix3 sum = Matrix3::Zero();
  for (std::size_t a = 0; a < 3; ++a)
    for (std::size_t b = 0; b < 3; ++b) sum += p.weights[a] * q.weights[b] * tissue.value(p.vertices[a], q.vertices[b]);
  return sum;
}

}  // namespace

TEST_CASE("compliance between points is J C J^T, independent of earlier requests", "[contact][point_compliance]") {
  CountingTissue tissue;
  const detail::Candidates points(detail::ContactSamples(tissue.surface, 0.004), nullptr, 8);
  const detail::ContactSamples& samples = points.samples();
  const int count = samples.first_of(static_cast<int>(tissue.surface.triangles().size()));
  REQUIRE(count > 24);
  detail::PointCompliance compliance(8);
  testing::Random random(61);
  std::vector<int> hint(static_cast<std::size_t>(count), -1);
  double worst = 0.0;
  for (int round = 0; round < 500; ++round) {
    compliance.begin_rows();
    std::vector<int> rows, slots;
    for (int k = 0; k < 8; ++k) {
      const int s = static_cast<int>(random.uniform(0.0, count - 1e-9));
      int& h = hint[static_cast<std::size_t>(s)];
      rows.push_back(s);
      slots.push_back(h = compliance.slot_of(tissue, points, s, round % 3 == 0 ? -1 : h));
    }
    for (std::size_t i = 0; i < rows.size(); ++i)
      for (std::size_t j = 0; j < rows.size(); ++j) {
        // One point has one slot, two points have two.
        CHECK((rows[i] == rows[j]) == (slots[i] == slots[j]));
        if (slots[i] < slots[j]) continue;
        const Matrix3 given = compliance(tissue, points, slots[i], slots[j]);
        worst = std::max(worst, (given - expected(tissue, samples[rows[i]], samples[rows[j]])).cwiseAbs().maxCoeff());
      }
  }
  CHECK(worst <= 1e-14);
}

TEST_CASE("cached compliance is not read again until the tissue's revision changes", "[contact][point_compliance]") {
  CountingTissue tissue;
  const detail::Candidates points(detail::ContactSamples(tissue.surface, 0.004), nullptr, 8);
  detail::PointCompliance compliance(8);
  const auto read = [&](int first) {
    tissue.reads = 0;
    compliance.begin_tick(tissue.compliance_revision());
    compliance.begin_rows();
    std::array<int, 4> slots;
    for (int k = 0; k < 4; ++k) slots[static_cast<std::size_t>(k)] = compliance.slot_of(tissue, points, first + k, -1);
    Matrix3 sum = Matrix3::Zero();
    for (int p : slots)
      for (int q : slots)
        if (p >= q) sum += compliance(tissue, points, p, q);
    return sum;
  };
  const Matrix3 first = read(3);
  CHECK(tissue.reads > 0);
  CHECK(read(3) == first);
  CHECK(tissue.reads == 0);
  read(4);  // one new point among three known ones
  const int one_point = tissue.reads;
  CHECK(one_point > 0);
  tissue.scale = 2.0;
  CHECK(read(3) == first);
  tissue.revision = 1;
  CHECK(read(3).isApprox(2.0 * first, 1e-14));
  CHECK(tissue.reads > one_point);
}

TEST_CASE("the half-space between points is kept while the surface turns and stretches",
          "[contact][point_compliance]") {
  StretchedTissue tissue;
  detail::Candidates points(detail::ContactSamples(tissue.surface, 0.004), subfacet_of(tissue.surface), 8);
  const int count = points.samples().first_of(static_cast<int>(tissue.surface.triangles().size()));
  const TissueView view(tissue);
  detail::PointCompliance kept(8);
  testing::Random random(62);
  double worst = 0.0;
  int pairs = 0;
  for (int round = 0; round < 200; ++round) {
    if (round % 3 == 0) ++tissue.revision;
    if (round % 40 == 20) {  // a pad is pinned, and released
      const std::array<int, 1> pad{5};
      points.pin(round % 80 == 20 ? std::span<const int>(pad) : std::span<const int>());
      kept.forget();
    }
    detail::PointCompliance fresh(8);
    std::vector<int> slots, own;
    for (detail::PointCompliance* c : {&kept, &fresh}) c->begin_tick(tissue.compliance_revision()), c->begin_rows();
    for (int k = 0; k < 6; ++k) {
      const int sample = static_cast<int>(random.uniform(0.0, round % 2 == 0 ? 8.0 : count - 1e-9));
      slots.push_back(kept.slot_of(view, points, sample, -1));
      own.push_back(fresh.slot_of(view, points, sample, -1));
    }
    for (std::size_t i = 0; i < slots.size(); ++i)
      for (std::size_t j = 0; j < slots.size(); ++j) {
        if (slots[i] < slots[j]) continue;
        const Matrix3 found = kept(view, points, slots[i], slots[j]);
        const Matrix3 right = own[i] >= own[j] ? Matrix3(fresh(view, points, own[i], own[j]))
                                               : Matrix3(fresh(view, points, own[j], own[i]).transpose());
        worst = std::max(worst, (found - right).cwiseAbs().maxCoeff());
        ++pairs;
      }
  }
  CHECK(pairs > 4000);
  CHECK(worst <= 1e-13);
}
