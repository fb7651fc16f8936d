// A contact compliance that learns from the last steps.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/vertex_compliance.hpp>

#include <array>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Corrections of a compliance by pairs of a change of forces y and the change of displacement s that it caused, such
/// that the corrected compliance maps y to s: inverse BFGS updates C' = C + a s^T - s w^T with w = C y / (s.y) and a =
/// (1 + y.w) / (s.y) s - w. One vector per vertex.
struct SecantTerms {
  static constexpr std::size_t most = 4;
  struct Term {
    std::vector<Vector3> s, w, a;
    double largest_s = 0.0, largest_a = 0.0;
    void resize(std::size_t vertices) {
      for (std::vector<Vector3>* x : {&s, &w, &a}) x->resize(vertices);
    }
  };
  std::array<Term, most> term;
  std::size_t count = 0;

  /// The sum of all corrections for vertices i and j [m/N].
  Matrix3 operator()(std::size_t i, std::size_t j) const noexcept {
    Matrix3 sum = Matrix3::Zero();
    for (std::size_t k = 0; k < count; ++k) {
      const Term& t = term[k];
      sum += t.a[i] * t.s[j].transpose() - t.s[i] * t.w[j].transpose();
    }
    return sum;
  }
  /// Adds the displacement of vertex i by these corrections under a force on vertex j to `u` [m].
  void add(std::size_t i, std::size_t j, const Vector3& force, Vector3& u) const noexcept {
    for (std::size_t k = 0; k < count; ++k) {
      const Term& t = term[k];
      u += t.s[j].dot(force) * t.a[i] - t.w[j].dot(force) * t.s[i];
    }
  }
  /// Upper bound of the magnitude of the corrections of vertex j.
  double bound(std::size_t j) const noexcept;
};

/// The last pairs, for steps that end in equilibrium (interface quasi-Newton methods of partitioned contact and
/// fluid-structure problems, Degroote, Bathe and Vierendeels 2009). Without them a servo whose compliance differs from
/// that of the deformed tissue may swing from step to step instead of converging. Only the constructor allocates.
class SecantCompliance {
 public:
  SecantCompliance() = default;
  /// For that many vertices, and at most that many forces at a time.
  SecantCompliance(std::size_t vertices, std::size_t most_forces);

  /// Forgets all pairs.
  void clear() noexcept { count_ = 0; }
  /// Records that `before`, `after` [N] caused displacements `from`, `to` of the vertices [m], unless the forces hardly
  /// changed, compared with the `error` of the equilibrium relative to the forces, or the pair has no positive
  /// compliance: then returns false.
  bool record(std::span<const VertexForce> before, std::span<const VertexForce> after, std::span<const Vector3> from,
              std::span<const Vector3> to, double error) noexcept;
  /// Work of the last pair relative to that which a compliance, rotated with the vertices, gives.
  double work_ratio(const VertexCompliance& compliance, const std::vector<Matrix3>& rotation) const noexcept;
  /// The corrections of a compliance for vertices rotated by `rotation`.
  void find_terms(const VertexCompliance& compliance, const std::vector<Matrix3>& rotation,
                  SecantTerms& terms) const noexcept;

  /// Smallest change of forces, relative to the forces, that is recorded; and relative to the error.
  static constexpr double smallest_change = 1e-3, smallest_change_of_error = 10.0;

 private:
  struct Pair {
    /// y: adds to the force on a vertex.
    void add(int vertex, const Vector3& f) noexcept;
    std::vector<VertexForce> force;  // y, every vertex once
    std::vector<Vector3> moved;      // s
  };
  std::array<Pair, SecantTerms::most> pair_;  // the newest last
  std::size_t count_ = 0;
};

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/moving/detail/secant_compliance.ipp>
#endif
