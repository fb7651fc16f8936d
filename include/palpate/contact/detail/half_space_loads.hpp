// The displacement of a point of a half-space under many loads.
#pragma once

#include <palpate/contact/detail/half_space.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/detail/packet.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Loads on points of half-spaces, stored so that several at a time act on a point: ticks after a jump spend most of
/// their time with it. The displacement is that of `supported_compliance` times each force, but for rounding.
class HalfSpaceLoads {
 public:
  /// Allocates; for set-up.
  explicit HalfSpaceLoads(int capacity) : blocks_(blocks_for(capacity)) {}

  /// Sets load i of 0 to i: those after it in its block have no force.
  void set(int i, const HalfSpacePoint& point, const Vector3& force) noexcept {
    Block& b = blocks_[static_cast<std::size_t>(i / lanes)];
    const int lane = i % lanes;
    if (lane == 0) b = {};
    for (std::size_t c = 0; c < 3; ++c) {
      const auto axis = static_cast<Index>(c);
      b.position[c].set(lane, point.position[axis]);
      b.normal[c].set(lane, point.normal[axis]);
      b.force[c].set(lane, force[axis]);
    }
    b.root.set(lane, point.root);
    b.poisson_ratio.set(lane, point.poisson_ratio);
    b.length.set(lane, point.length);
    b.body.set(lane, point.body);
  }

  /// Adds the displacement of p under the first `count` loads on its body that are not at its place [m]. About 100
  /// flops per load; no allocation.
  void add_displacement(int count, const HalfSpacePoint& p, Vector3& u) const noexcept {
    Vectors sum{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < blocks_for(count); ++i) add_block(blocks_[i], p, sum);
    for (std::size_t c = 0; c < 3; ++c)
      for (int l = 0; l < lanes; ++l) u[static_cast<Index>(c)] += sum[c][l];
  }

 private:
  static constexpr int lanes = detail::packet_size > 2 ? 4 : 2;  // of one register
  using Numbers = Lanes<double, lanes>;
  using Vectors = std::array<Numbers, 3>;
  struct Block {
    Vectors position{0.0, 0.0, 0.0}, normal = position, force = position;
    Numbers root = 0.0, poisson_ratio = 0.0, length = 1.0, body = 0.0;
  };

  static std::size_t blocks_for(int loads) noexcept { return static_cast<std::size_t>((loads + lanes - 1) / lanes); }
  PALPATE_ALWAYS_INLINE static Vectors all(const Vector3& v) noexcept { return {v[0], v[1], v[2]}; }
  PALPATE_ALWAYS_INLINE static Numbers dot(const Vectors& a, const Vectors& b) noexcept {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  }
  /// The step of half_space_support.
  PALPATE_ALWAYS_INLINE static Numbers step(const Numbers& at) noexcept {
    const Numbers t = min(max(at, Numbers(0.0)), Numbers(1.0)), rest = 1.0 - t;
    return rest * rest * rest * (1.0 + t * (3.0 + 6.0 * t));
  }

  static void add_block(const Block& b, const HalfSpacePoint& p, Vectors& sum) noexcept {
    constexpr double rounding = 1e-9;
    const Vectors at = all(p.position), normal = all(p.normal);
    const Vectors d{at[0] - b.position[0], at[1] - b.position[1], at[2] - b.position[2]};
    const Numbers edges = p.length + b.length, square = edges * edges, squared = dot(d, d);
    if (!any(squared < 4.0 * square)) return;
    // Nothing of loads at the same place or on other bodies.
    const Numbers near = (rounding * rounding) * square;
    const auto apart = (near < squared) & (abs(b.body - static_cast<double>(p.body)) < Numbers(0.5));
    const Numbers distance = sqrt(max(squared, near)), per_length = 1.0 / distance;
    const Numbers support =
        select(apart, step(distance / edges - 1.0) * step(-2.0 * dot(normal, b.normal)), Numbers(0.0));
    const Vectors n{0.5 * (normal[0] + b.normal[0]), 0.5 * (normal[1] + b.normal[1]), 0.5 * (normal[2] + b.normal[2])};
    const Numbers nu = 0.5 * (p.poisson_ratio + b.poisson_ratio), scale = support * p.root * b.root * per_length;
    const Numbers across = scale * (1.0 - 2.0 * nu) * per_length, along = dot(d, b.force);
    const Numbers of_d = 2.0 * scale * nu * per_length * per_length * along + across * dot(n, b.force);
    const Numbers of_force = 2.0 * scale * (1.0 - nu), of_n = across * along;
    for (std::size_t c = 0; c < 3; ++c) sum[c] += of_force * b.force[c] + of_d * d[c] - of_n * n[c];
  }

  std::vector<Block> blocks_;
};

}}  // namespace palpate
