// Coulomb friction of the contacts of a tick, for known normal forces.
#pragma once

#include <palpate/core/types.hpp>

#include <array>
#include <cstddef>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Coulomb's law over one tick: the friction force of contact i is a tangential t_i, |t_i| <= mu lambda_i, such that it
/// does not slip, or has the full size mu lambda_i against the slip. Slips are s_i = d_i + sum_j W_ij (lambda_j n_j +
/// t_j), where d_i is the slip without forces since the point last stuck. With lambda fixed the t_i minimise a convex
/// energy over discs; found by block descent with projection (Duriez et al. 2006 after Moreau and Alart): continuous in
/// all inputs, no switch between sticking and sliding, no regularised velocity. It starts from the friction forces of
/// the last tick, so that a few sweeps suffice, O(rows^2) each. Vectors are kept in the frames of the contacts: two
/// tangents and the normal. No allocation after construction.
class CoulombFriction {
 public:
  static constexpr int maximum_sweeps = 4;   ///< of `improve`
  static constexpr double tolerance = 1e-4;  ///< change of t in a sweep, relative to the largest mu lambda

  /// For up to `capacity` contacts. Allocates unless the coefficient is zero; for set-up.
  CoulombFriction(double coefficient, int capacity);

  bool acts() const noexcept { return coefficient_ > 0.0; }
  double coefficient() const noexcept { return coefficient_; }
  /// Changes the coefficient. It stays zero, or above 1e-9: workspaces and contacts in progress are those of its kind.
  void set_coefficient(double coefficient) noexcept {
    if (acts()) coefficient_ = coefficient > 1e-9 ? coefficient : 1e-9;
  }

  /// Contact i: its unit normal, the drift d_i [m], and the friction force on the tool to start from [N]. A contact
  /// that does not stick has no friction: it came into contact in this tick.
  void set(int i, const Vector3& normal, const Vector3& drift, const Vector3& friction_force, bool sticks) noexcept;
  /// Its tangents, unit vectors.
  std::array<Vector3, 2> tangents(int i) const noexcept {
    const Frame& f = frame_[at(i)];
    return {Vector3(f.x.first, f.y.first, f.z.first), Vector3(f.x.second, f.y.second, f.z.second)};
  }
  /// Displacements of tool over tissue at i per force at all j <= i [m/N], in the frames of both contacts: along axis a
  /// of i per force along axis b of j at w[(3 a + b) stride + j]. The axes are two tangents and the normal. Those at j
  /// per force at i are the transpose.
  void set_row(int i, const double* w, std::size_t stride) noexcept;
  /// Sets the normal forces of the first `count` contacts, whose W is set.
  void begin(int count, const double* lambda) noexcept;
  /// Changes the normal forces; friction forces above mu lambda are shortened.
  void press(const double* lambda) noexcept;
  /// Some sweeps of block descent for the present normal forces. False when the friction forces already were the
  /// solution, up to the tolerance.
  bool improve() noexcept;

  /// Friction force on the tool [N].
  Vector3 force(int i) const noexcept { return in_model(i, force_[at(i)]); }
  /// Displacement due to the friction forces at contact i, tool over tissue, along the normal [m]. O(rows).
  double normal_displacement(int i) const noexcept;

 private:
  /// Components along the two tangents of a contact. Not an Eigen vector: expressions of these cost much to compile.
  struct Pair {
    double first = 0.0, second = 0.0;

    friend Pair operator+(const Pair& a, const Pair& b) noexcept { return {a.first + b.first, a.second + b.second}; }
    friend Pair operator-(const Pair& a, const Pair& b) noexcept { return {a.first - b.first, a.second - b.second}; }
    friend Pair operator*(double a, const Pair& b) noexcept { return {a * b.first, a * b.second}; }
    double dot(const Pair& b) const noexcept { return first * b.first + second * b.second; }
  };
  static_assert(sizeof(Pair) == 2 * sizeof(double));  // arrays of pairs are read as arrays of numbers
  struct Frame {
    Pair x, y, z;  // components of both tangents
    Pair along(const Vector3& v) const noexcept { return v[0] * x + v[1] * y + v[2] * z; }
    bool sticks = false;
  };
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  std::size_t index(int i, int j) const noexcept { return at(i) * capacity_ + at(j); }
  const double* along_row(int i) const noexcept { return &along_[index(i, 0)].first; }
  const double* across_row(int i) const noexcept { return &across_[index(i, 0)].first; }
  Vector3 in_model(int i, const Pair& p) const noexcept {
    const Frame& f = frame_[at(i)];
    return {f.x.dot(p), f.y.dot(p), f.z.dot(p)};
  }
  inline Pair project(int i, const Pair& friction_force) const noexcept;
  inline Pair tangential_displacement(int i) const noexcept;
  void slip_by_normal_forces() noexcept;
  double sweep() noexcept;

  double coefficient_;
  std::size_t capacity_;
  int count_ = 0;
  std::vector<Pair> along_;   // row 2 j + c: tangential displacements per force at j along its tangent c
  std::vector<Pair> across_;  // row i: normal displacement there per tangential force at j, and the reverse
  std::vector<Frame> frame_;
  std::vector<double> pressing_, step_;
  std::vector<Pair> force_, drift_, slip_;  // slip: without friction forces
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/coulomb_friction.ipp>
#endif
