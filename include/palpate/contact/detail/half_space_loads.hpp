// The displacement of a point of a half-space under many loads.
#pragma once

#include <palpate/contact/detail/half_space.hpp>

#include <Eigen/StdVector>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Loads on points of half-spaces, stored so that four at a time act on a point: ticks after a jump spend most of their
/// time with it. The displacement is that of `supported_compliance` times each force, but for rounding.
class HalfSpaceLoads {
 public:
  /// Allocates; for set-up.
  explicit HalfSpaceLoads(int capacity) : blocks_(static_cast<std::size_t>((capacity + lanes - 1) / lanes)) {}

  /// Sets load i of 0 to i: those after it have no force, up to the next multiple of four.
  void set(int i, const HalfSpacePoint& point, const Vector3& force) noexcept {
    Block& b = blocks_[static_cast<std::size_t>(i / lanes)];
    const int lane = i % lanes;
    if (lane == 0) b = {};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Index>(c);
      b.position[c][lane] = point.position[axis];
      b.normal[c][lane] = point.normal[axis];
      b.force[c][lane] = force[axis];
    }
    b.root[lane] = point.root;
    b.poisson_ratio[lane] = point.poisson_ratio;
    b.length[lane] = point.length;
    b.body[lane] = point.body;
  }

  /// Adds the displacement of p under the first `count` loads on its body that are not at its place [m]. About 100
  /// flops per load; no allocation.
  void add_displacement(int count, const HalfSpacePoint& p, Vector3& u) const noexcept {
    Vectors sum{Lanes::Zero(), Lanes::Zero(), Lanes::Zero()};
    for (std::size_t i = 0; i < static_cast<std::size_t>((count + lanes - 1) / lanes); ++i)
      add_block(blocks_[i], p, sum);
    for (std::size_t c = 0; c < 3; ++c) u[static_cast<Index>(c)] += sum[c].sum();
  }

 private:
  static constexpr int lanes = 4;
  using Lanes = Eigen::Array<double, lanes, 1>;
  using Vectors = std::array<Lanes, 3>;
  struct Block {
    Vectors position{Lanes::Zero(), Lanes::Zero(), Lanes::Zero()}, normal = position, force = position;
    Lanes root = Lanes::Zero(), poisson_ratio = Lanes::Zero(), length = Lanes::Ones(), body = Lanes::Zero();
  };

  static Lanes dot(const Vectors& a, const Vectors& b) noexcept { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
  /// The step of half_space_support.
  static Lanes step(const Lanes& at) noexcept {
    const Lanes t = at.max(0.0).min(1.0), rest = 1.0 - t;
    return rest * rest * rest * (1.0 + t * (3.0 + 6.0 * t));
  }

  static void add_block(const Block& b, const HalfSpacePoint& p, Vectors& sum) noexcept {
    constexpr double rounding = 1e-9;
    const Vectors d{p.position[0] - b.position[0], p.position[1] - b.position[1], p.position[2] - b.position[2]};
    const Lanes edges = p.length + b.length, square = edges * edges, squared = dot(d, d);
    if ((squared - 4.0 * square).minCoeff() >= 0.0) return;
    // Nothing of loads at the same place or on other bodies: one for those, else 0.
    const Lanes near = rounding * rounding * square;
    const Lanes here = (2.0 - squared / near).max(0.0).min(1.0).max((b.body - p.body).abs().min(1.0));
    const Lanes distance = squared.max(near).sqrt(), per_length = 1.0 / distance;
    const Lanes normals = p.normal[0] * b.normal[0] + p.normal[1] * b.normal[1] + p.normal[2] * b.normal[2];
    const Lanes support = (1.0 - here) * step(distance / edges - 1.0) * step(-2.0 * normals);
    const Vectors n{0.5 * (p.normal[0] + b.normal[0]), 0.5 * (p.normal[1] + b.normal[1]),
                    0.5 * (p.normal[2] + b.normal[2])};
    const Lanes nu = 0.5 * (p.poisson_ratio + b.poisson_ratio), scale = support * p.root * b.root * per_length;
    const Lanes across = scale * (1.0 - 2.0 * nu) * per_length, along = dot(d, b.force);
    const Lanes of_d = 2.0 * scale * nu * per_length * per_length * along + across * dot(n, b.force);
    const Lanes of_force = 2.0 * scale * (1.0 - nu), of_n = across * along;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += of_force * b.force[c] + of_d * d[c] - of_n * n[c];
  }

  std::vector<Block, Eigen::aligned_allocator<Block>> blocks_;
};

}}  // namespace palpate
