// A batch of tetrahedra, and the parts of a batched force that are also compiled for other processors.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/detail/lane_rows.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/tensor3.hpp>
#include <palpate/core/types.hpp>

#include <cstdint>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// N tetrahedra of one region. Lanes without an element have zero gradients and volume, so F = I there.
template <class S, int N>
struct TetrahedronBatch {
  Triple<Lanes<S, N>> gradient[3];  ///< of nodes 1, 2, 3 [1/m]; that of node 0 is minus their sum
  Lanes<S, N> volume;               ///< at rest [m^3]
  std::uint16_t row[4][N];          ///< 4 times the index of every node among those of the block

  /// u_a - u_0 for a = 1, 2, 3, from rows of four numbers.
  PALPATE_ALWAYS_INLINE void differences(const S* u, Triple<Lanes<S, N>> (&d)[3]) const noexcept {
    const Triple<Lanes<S, N>> u0 = load_rows<S, N>(u, row[0]);
    for (int a = 0; a < 3; ++a) {
      const Triple<Lanes<S, N>> ua = load_rows<S, N>(u, row[a + 1]);
      d[a] = {ua.x - u0.x, ua.y - u0.y, ua.z - u0.z};
    }
  }
  /// Adds forces on nodes 1, 2, 3, and minus their sum on node 0, to rows of four numbers.
  PALPATE_ALWAYS_INLINE void add_balanced(const Triple<Lanes<S, N>>& f1, const Triple<Lanes<S, N>>& f2,
                                          const Triple<Lanes<S, N>>& f3, S* force) const noexcept {
    add_rows(force, row[1], f1);
    add_rows(force, row[2], f2);
    add_rows(force, row[3], f3);
    add_rows(force, row[0], Triple<Lanes<S, N>>{-(f1.x + f2.x + f3.x), -(f1.y + f2.y + f3.y), -(f1.z + f2.z + f3.z)});
  }

  /// F = I + sum over a = 1, 2, 3 of (u_a - u_0) grad N_a.
  PALPATE_ALWAYS_INLINE Tensor3<Lanes<S, N>> deformation_gradient(const S* u) const noexcept {
    Triple<Lanes<S, N>> d[3];
    differences(u, d);
    return plus_identity(outer(d[0], gradient[0]) + outer(d[1], gradient[1]) + outer(d[2], gradient[2]),
                         Lanes<S, N>(S(1)));
  }
  /// f_a += V P grad N_a.
  PALPATE_ALWAYS_INLINE void add_force(const Tensor3<Lanes<S, N>>& stress, S* force) const noexcept {
    const Tensor3<Lanes<S, N>> p = volume * stress;
    add_balanced(p * gradient[0], p * gradient[1], p * gradient[2], force);
  }
};

inline constexpr Index tetrahedra_per_block = 512;

/// Displacements of a block's nodes minus that of its first node, in rows of four numbers: single precision then keeps
/// the digits of strain instead of those of position.
template <class S>
PALPATE_ALWAYS_INLINE void load_relative(const NodeId* nodes, Index rows, const double* u, S* local) noexcept {
  const double* const u0 = u + 3 * Index{nodes[0]};
  const double origin[3] = {u0[0], u0[1], u0[2]};
  for (Index r = 0; r < rows; ++r) {
    const double* const ur = u + 3 * Index{nodes[r]};
    for (int c = 0; c < 3; ++c) local[4 * r + c] = static_cast<S>(ur[c] - origin[c]);
    local[4 * r + 3] = S(0);
  }
}

/// Per lane: smallest J of a block, its batch, the number of positive J, and whether one is not finite.
template <class S, int N>
struct VolumeLanes {
  Lanes<S, N> smallest{std::numeric_limits<S>::infinity()}, batch{S(-1)}, upright{S(0)}, broken{S(0)};
  S at = S(0);

  /// Adds a batch: its J, and its volumes at rest. Lanes without an element have volume zero and do not count.
  PALPATE_ALWAYS_INLINE void observe(const Lanes<S, N>& j, const Lanes<S, N>& volume) noexcept {
    const Lanes<S, N> none(std::numeric_limits<S>::infinity()), zero(S(0)), one(S(1));
    const Lanes<S, N> seen = select(volume > zero, j, none);
    const auto ahead = seen < smallest;
    smallest = select(ahead, seen, smallest);
    batch = select(ahead, Lanes<S, N>(at), batch);
    broken += j - j;  // zero; NaN once a J was not finite
    upright += select(seen > zero, one, zero);
    at += S(1);
  }
};

}}}  // namespace palpate::detail
