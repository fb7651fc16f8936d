// Spatial gradients of elements with constant gradients, scaled for products of pairs.
#pragma once

#include <palpate/assembly/detail/constant_geometry.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/detail/thread_ranges.hpp>
#include <palpate/core/executor.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>
#include <palpate/local/geometry.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Spatial gradients [1/m] of all elements times the square root of the volume; K_ab is a sum of products of these. The
/// same bits for any number of threads.
template <ConstantGradient E>
class ScaledGradients {
 public:
  /// The memory in bytes.
  static double bytes(const Mesh<E>& mesh) {
    return sizeof(double) * (static_cast<double>(mesh.element_count()) * stride + 1);
  }

  /// Throws inverted_element for a volume that is not positive, non_finite for one that is not finite. Allocates.
  explicit ScaledGradients(const Mesh<E>& mesh, const SetupThreads& threads)
      : mesh_(mesh), values_(static_cast<std::size_t>(mesh.element_count() * stride + 1)) {
    const Index count = mesh.element_count();
    std::vector<Index> refused(static_cast<std::size_t>(threads.threads()), count);  // per thread: the first element
    detail::thread_ranges(count, 8192, threads, [&](int thread, Index begin, Index end) {
      Index& first = refused[static_cast<std::size_t>(thread)];
      for (Index e = begin; e < end && first == count; e += lanes) {
        const Index bad = fill(e, std::min<Index>(end - e, lanes));
        if (bad >= 0) first = bad;
      }
    });
    const Index first = *std::min_element(refused.begin(), refused.end());
    if (first == count) return;
    constant_geometry(mesh, first);  // throws
    raise_element(SetupErrorKind::non_finite, first, "has a stiffness that is not finite");
  }

  /// The gradient of node a of element e: three numbers. A fourth can be read, and has no meaning.
  const double* of(Index e, int a) const noexcept { return values_.data() + e * stride + 3 * a; }

 private:
  static constexpr int lanes = 2;
  static constexpr Index stride = 3 * E::nodes;
  using Number = Lanes<double, lanes>;

  /// Elements e ... e + count - 1, count <= lanes. Returns the first that has no positive volume or gradients that are
  /// not finite, -1 if there is none.
  Index fill(Index e, Index count) noexcept {
    constexpr auto point = E::Quadrature::points[0];
    const Eigen::Matrix<double, E::nodes, 3> reference = E::gradient(reference_point(point));
    const Number zero(0.0);
    Tensor3<Number> jacobian = Tensor3<Number>::diagonal(zero, zero, zero);
    for (int a = 1; a < E::nodes; ++a) {
      const Triple<Number> edge = edges(e, count, a);
      for (int j = 0; j < 3; ++j) {
        const Number n(reference.coeff(a, j));
        jacobian(0, j) += edge.x * n;
        jacobian(1, j) += edge.y * n;
        jacobian(2, j) += edge.z * n;
      }
    }
    const Tensor3<Number> cofactors = cofactor(jacobian);
    const Number determinant_j = determinant(jacobian, cofactors), volume = Number(point.weight) * determinant_j;
    const Number scale = sqrt(volume), over = Number(1.0) / determinant_j;
    Number invalid = zero;  // stays zero, or becomes NaN
    for (int a = 0; a < E::nodes; ++a)
      for (int i = 0; i < 3; ++i) {
        Number g = cofactors(i, 0) * Number(reference.coeff(a, 0)) + cofactors(i, 1) * Number(reference.coeff(a, 1)) +
                   cofactors(i, 2) * Number(reference.coeff(a, 2));
        g = g * over;
        invalid += g - g;
        g = g * scale;
        for (Index l = 0; l < count; ++l)
          values_[static_cast<std::size_t>((e + l) * stride + 3 * a + i)] = g[static_cast<int>(l)];
      }
    for (int l = 0; l < static_cast<int>(count); ++l)
      if (!(volume[l] > 0.0 && invalid[l] <= 0.0)) return e + l;
    return -1;
  }

  /// x_a - x_0 of the elements; lanes beyond `count` repeat the last one.
  Triple<Number> edges(Index e, Index count, int a) const noexcept {
    Triple<Number> edge;
    for (int l = 0; l < lanes; ++l) {
      const auto& nodes = mesh_.elements[static_cast<std::size_t>(e + std::min<Index>(l, count - 1))];
      const Vector3& x0 = mesh_.positions[static_cast<std::size_t>(nodes[0])];
      const Vector3& xa = mesh_.positions[static_cast<std::size_t>(nodes[static_cast<std::size_t>(a)])];
      edge.x.set(l, xa.x() - x0.x());
      edge.y.set(l, xa.y() - x0.y());
      edge.z.set(l, xa.z() - x0.z());
    }
    return edge;
  }

  const Mesh<E>& mesh_;
  std::vector<double> values_;
};

}}  // namespace palpate
