// The displacement of a point of a half-space under many loads.
#pragma once

#include <palpate/contact/detail/contact_kernels_here.hpp>
#include <palpate/contact/detail/half_space.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Loads on points of half-spaces, stored so that several at a time act on a point: ticks after a jump spend most of
/// their time with it. The displacement is that of `supported_compliance` times each force, but for rounding.
class HalfSpaceLoads {
 public:
  /// Allocates; for set-up.
  explicit HalfSpaceLoads(int capacity, const any_flags::ContactKernels& kernels = detail::contacts_here)
      : kernels_(&kernels),
        numbers_(numbers * lanes * any_flags::contact_groups(capacity), 1.0) {}  // the kernel divides by lengths

  /// Sets load i of 0 to i: those after it in its group have no force.
  void set(int i, const HalfSpacePoint& point, const Vector3& force) noexcept {
    const std::size_t lane = static_cast<std::size_t>(i) % lanes;
    double* const group = &numbers_[numbers * lanes * (static_cast<std::size_t>(i) / lanes)];
    if (lane == 0)
      for (std::size_t k = any_flags::half_space_force * lanes; k < numbers * lanes; ++k) group[k] = 0.0;
    const Numbers own = numbers_of(point);
    for (std::size_t c = 0; c < own.size(); ++c) group[c * lanes + lane] = own[c];
    for (std::size_t c = 0; c < 3; ++c)
      group[(any_flags::half_space_force + c) * lanes + lane] = force[static_cast<Index>(c)];
  }

  /// Adds the displacement of p under the first `count` loads on its body that are not at its place [m]. About 100
  /// flops per load; no allocation.
  void add_displacement(int count, const HalfSpacePoint& p, Vector3& u) const noexcept {
    const Numbers point = numbers_of(p);
    kernels_->add_half_space(numbers_.data(), count, point.data(), u.data());
  }

 private:
  static constexpr std::size_t lanes = any_flags::contacts_at_once, numbers = any_flags::half_space_numbers;
  using Numbers = std::array<double, any_flags::half_space_force>;
  static Numbers numbers_of(const HalfSpacePoint& p) noexcept {
    return {p.position[0], p.position[1], p.position[2],   p.normal[0], p.normal[1],
            p.normal[2],   p.root,        p.poisson_ratio, p.length,    static_cast<double>(p.body)};
  }

  const any_flags::ContactKernels* kernels_;
  std::vector<double> numbers_;
};

}}  // namespace palpate
