// The compliance between points of the surface of an elastic half-space, and the displacement under many loads on it.
#pragma once

#include <palpate/contact/detail/contact_kernels_here.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A point of a surface, and the half-space that the body is near it.
struct HalfSpacePoint {
  Vector3 position = Vector3::Zero();  ///< at rest [m]
  Vector3 normal = Vector3::Zero();    ///< outward, unit
  double root = 0.0;                   ///< 1 / sqrt(4 pi mu) [sqrt(m^2/N)], see `root_of`
  double poisson_ratio = 0.0;          ///< nu
  double length = 0.0;                 ///< mean length of the edges here [m]: the scale of half_space_support
  double edge_nearness = 0.0;          ///< nearness of a sharp edge, linear between vertices: above 1 is too near
  double bending_error = 0.0;          ///< of the stiffness of a thin body in bending, relative, by its elements
  int body = 0;                        ///< part of the mesh that shares no node with others: these have nothing of it
  bool is_disturbed = false;           ///< too different from a half-space for its elements: edge, support, another
                                       ///< material or a cut
  bool is_fixed = false;               ///< its displacement along the normal is prescribed: `root` is 0

  bool is_known() const noexcept { return root > 0.0; }

  /// For a shear modulus mu [Pa].
  static double root_of(double mu) noexcept { return 0.5 * std::numbers::inv_sqrtpi / std::sqrt(mu); }
};

/// The displacement of the surface of a half-space at p per force on it at q [m/N], rows displacement, columns force:
///   1 / (4 pi mu) (2 (1 - nu) I / r + 2 nu d d^T / r^3 + (1 - 2 nu) (d n^T - n d^T) / r^2)
/// with d = p - q, r = |d| and n the outward normal (Boussinesq 1885, Cerruti 1882; Johnson, Contact Mechanics, 1985,
/// 3.2 and 3.6). Exact on a plane with one material. Elsewhere n and nu are means and mu the geometric mean, so that
/// swapping p and q transposes the result. Finite for nu from 0 to 0.5. p and q must differ. About 40 flops, a root and
/// two divisions.
PALPATE_ALWAYS_INLINE Matrix3 half_space_compliance(const HalfSpacePoint& p, const HalfSpacePoint& q) noexcept {
  const Vector3 d = p.position - q.position, n = 0.5 * (p.normal + q.normal);
  const double nu = 0.5 * (p.poisson_ratio + q.poisson_ratio);
  const double per_length = 1.0 / d.norm(), scale = p.root * q.root * per_length;
  const double same = scale * 2.0 * (1.0 - nu), along = scale * 2.0 * nu * per_length * per_length;
  const double across = scale * (1.0 - 2.0 * nu) * per_length;
  Matrix3 g;
  for (int j = 0; j < 3; ++j)
    for (int i = 0; i < 3; ++i)
      g.coeffRef(i, j) = (i == j ? same : 0.0) + along * d[i] * d[j] + across * (d[i] * n[j] - n[i] * d[j]);
  return g;
}

/// The displacement of a point per force on its part of the surface [m/N]: in the middle of a disc under uniform
/// traction, normal (1 - nu) / (pi mu rho), tangential (2 - nu) / (2 pi mu rho) (Johnson 1985, 3.4 and 3.7). With
/// `area` [m^2] that the point stands for, rho = sqrt(area / pi) / 1.06. The factor is fitted: with it a rigid sphere
/// on a half-space gets the force of Hertz within 0.6 % on average, for 7 to 37 points in contact, and Mindlin's
/// tangential stiffness within 3 %; without it it is 1 to 2.4 % too stiff.
inline Matrix3 half_space_self_compliance(const HalfSpacePoint& p, double area) noexcept {
  constexpr double fitted = 1.06;
  const double nu = p.poisson_ratio, radius = std::sqrt(area * std::numbers::inv_pi) / fitted;
  const double scale = 2.0 * p.root * p.root / radius, tangential = scale * (2.0 - nu);
  const double normal = scale * 2.0 * (1.0 - nu);
  return tangential * Matrix3::Identity() + (normal - tangential) * (p.normal * p.normal.transpose());
}

/// How much of half_space_compliance counts between two points. By distance: 1 up to twice the mean length of their
/// edges, 0 from four times that on, because the mesh itself shows well what points do that are far apart. By
/// direction: 1 where the normals are less than a right angle apart, 0 from 120 degrees on, so that the two sides of a
/// slit or of a thin fold have nothing of each other. Twice continuously differentiable, symmetric. `distance` is in
/// the sum of the two edges, `normals` the product of the normals.
PALPATE_ALWAYS_INLINE double half_space_support(double distance, double normals) noexcept {
  const auto step = [](double t) noexcept {  // from 1 at t = 0 to 0 at t = 1
    const double rest = 1.0 - t;
    return t <= 0.0 ? 1.0 : !(t < 1.0) ? 0.0 : rest * rest * rest * (1.0 + t * (3.0 + 6.0 * t));
  };
  const double nearness = step(distance - 1.0);
  return nearness > 0.0 ? nearness * step(-2.0 * normals) : 0.0;
}
PALPATE_ALWAYS_INLINE double half_space_support(const HalfSpacePoint& p, const HalfSpacePoint& q) noexcept {
  if (p.body != q.body) return 0.0;
  return half_space_support((p.position - q.position).norm() / (p.length + q.length), p.normal.dot(q.normal));
}

inline bool is_same_place(const HalfSpacePoint& p, const HalfSpacePoint& q) noexcept {
  constexpr double rounding = 1e-9;
  return p.body == q.body && !((p.position - q.position).norm() > rounding * (p.length + q.length));
}

/// half_space_compliance times half_space_support: what is added to the compliance of the mesh between two points
/// [m/N]. Zero for points at the same place.
inline Matrix3 supported_compliance(const HalfSpacePoint& p, const HalfSpacePoint& q) noexcept {
  const double support = half_space_support(p, q);
  if (!(support > 0.0) || is_same_place(p, q)) return Matrix3::Zero();
  return support * half_space_compliance(p, q);
}

/// Loads on points of half-spaces, stored so that several at a time act on a point: ticks after a jump spend most of
/// their time with it. The displacement is that of `supported_compliance` times each force, but for rounding.
class HalfSpaceLoads {
 public:
  /// Allocates; for set-up.
  explicit HalfSpaceLoads(int capacity, const any_flags::ContactKernels& kernels = contacts_here)
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

}}}  // namespace palpate::detail
