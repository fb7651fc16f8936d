// The inner loops of the contact problem of a tick, compiled with the flags of the including source.
#pragma once

#include <palpate/core/detail/lanes.hpp>

#include <cstddef>

namespace palpate {

// The same types for all compiler flags, as in linear/detail/kernel_types.hpp.
namespace any_flags {

/// Rows, or loads, that are stored together: component by component, so that one instruction has the same component of
/// several.
inline constexpr int contacts_at_once = 4;
inline constexpr std::size_t contact_groups(int count) noexcept {
  return static_cast<std::size_t>((count + contacts_at_once - 1) / contacts_at_once);
}

/// The arrays of RowCompliance. Blocks are 3 x 3, by columns.
struct RowBlocks {
  const double* blocks;      ///< groups of those with j < i
  const std::size_t* first;  ///< of a row i: number of its first group
  const double* diagonal;    ///< those with j = i, in turn
  const double* axes[3];     ///< groups of vectors: two tangents and the normal
  const double* arms;        ///< groups of vectors
  const double* tools;       ///< one number per row
  double* sums;              ///< workspace: a vector per row
};
/// The coupling of a tool.
struct CouplingCompliance {
  double translation = 0.0;  ///< [m/N]
  double rotation = 0.0;     ///< [rad/(N m)]
};

/// Numbers of a HalfSpacePoint, and in HalfSpaceLoads groups of such numbers with a force.
enum HalfSpaceNumber {
  half_space_position = 0,
  half_space_normal = 3,
  half_space_root = 6,
  half_space_poisson_ratio,
  half_space_length,
  half_space_body,
  half_space_force,
  half_space_numbers = half_space_force + 3
};

/// Kernels compiled with the same flags. Their functions: RowCompliance and HalfSpaceLoads.
struct ContactKernels {
  void (*along_normals)(const RowBlocks& rows, int i, const CouplingCompliance& coupling, double* w) noexcept;
  void (*in_axes)(const RowBlocks& rows, int i, const CouplingCompliance& coupling, std::size_t stride,
                  double* w) noexcept;
  void (*displace)(const RowBlocks& rows, int count, int loaded, const double* forces, double* moved) noexcept;
  void (*add_half_space)(const double* loads, int count, const double* point, double* u) noexcept;
};

// Defined in palpate::compiled, each in a source of its own (cmake/compiled.cmake).
extern const ContactKernels contacts_avx2, contacts_avx512;

}  // namespace any_flags
}  // namespace palpate

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

using ContactNumbers = Lanes<double, any_flags::contacts_at_once>;

// Members, not arrays: arrays that a function returns are copied by GCC, which costs more than the sums.
template <class N>
struct ContactVector {
  N x, y, z;
};
/// 3 x 3, by columns.
template <class N>
struct ContactBlock {
  N xx, yx, zx, xy, yy, zy, xz, yz, zz;
};

/// The numbers of component c of a group of vectors, blocks or loads with `components`.
template <std::size_t Components>
PALPATE_ALWAYS_INLINE ContactNumbers load_contacts(const double* groups, std::size_t group, std::size_t c) noexcept {
  return ContactNumbers::load(groups + (group * Components + c) * any_flags::contacts_at_once);
}
PALPATE_ALWAYS_INLINE ContactVector<ContactNumbers> load_vectors(const double* groups, std::size_t group) noexcept {
  return {load_contacts<3>(groups, group, 0), load_contacts<3>(groups, group, 1), load_contacts<3>(groups, group, 2)};
}
PALPATE_ALWAYS_INLINE ContactBlock<ContactNumbers> load_blocks(const double* groups, std::size_t group) noexcept {
  return {load_contacts<9>(groups, group, 0), load_contacts<9>(groups, group, 1), load_contacts<9>(groups, group, 2),
          load_contacts<9>(groups, group, 3), load_contacts<9>(groups, group, 4), load_contacts<9>(groups, group, 5),
          load_contacts<9>(groups, group, 6), load_contacts<9>(groups, group, 7), load_contacts<9>(groups, group, 8)};
}
/// The vector of one row.
PALPATE_ALWAYS_INLINE ContactVector<double> contact_vector(const double* groups, int i) noexcept {
  constexpr int lanes = any_flags::contacts_at_once;
  const double* const from = groups + i / lanes * 3 * lanes + i % lanes;
  return {from[0], from[lanes], from[2 * lanes]};
}
PALPATE_ALWAYS_INLINE ContactVector<ContactNumbers> in_all_lanes(const ContactVector<double>& v) noexcept {
  return {ContactNumbers(v.x), ContactNumbers(v.y), ContactNumbers(v.z)};
}
template <class N>
PALPATE_ALWAYS_INLINE N dot(const ContactVector<N>& a, const ContactVector<N>& b) noexcept {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class N>
PALPATE_ALWAYS_INLINE ContactVector<N> product(const ContactBlock<N>& a, const ContactVector<N>& v) noexcept {
  return {a.xx * v.x + a.xy * v.y + a.xz * v.z, a.yx * v.x + a.yy * v.y + a.yz * v.z,
          a.zx * v.x + a.zy * v.y + a.zz * v.z};
}
template <class N>
PALPATE_ALWAYS_INLINE ContactVector<N> transposed_product(const ContactBlock<N>& a,
                                                          const ContactVector<N>& v) noexcept {
  return {a.xx * v.x + a.yx * v.y + a.zx * v.z, a.xy * v.x + a.yy * v.y + a.zy * v.z,
          a.xz * v.x + a.yz * v.y + a.zz * v.z};
}

/// Adds translation and rotation of a tool at i by a force at j. `same`: 1 where both rows are of one tool, else 0.
template <class N>
PALPATE_ALWAYS_INLINE void add_coupling(const any_flags::CouplingCompliance& coupling, const N& same,
                                        const ContactVector<N>& arm_i, const ContactVector<N>& arm_j,
                                        ContactBlock<N>& a) noexcept {
  N own = coupling.translation * same;
  if (coupling.rotation > 0.0) {
    const N rotation = coupling.rotation * same;
    own += rotation * dot(arm_i, arm_j);
    const ContactVector<N> r{rotation * arm_j.x, rotation * arm_j.y, rotation * arm_j.z};
    a.xx -= r.x * arm_i.x, a.yx -= r.y * arm_i.x, a.zx -= r.z * arm_i.x;
    a.xy -= r.x * arm_i.y, a.yy -= r.y * arm_i.y, a.zy -= r.z * arm_i.y;
    a.xz -= r.x * arm_i.z, a.yz -= r.y * arm_i.z, a.zz -= r.z * arm_i.z;
  }
  a.xx += own, a.yy += own, a.zz += own;
}

/// 1 for the rows of a group that have the tool of row i, else 0.
PALPATE_ALWAYS_INLINE ContactNumbers of_same_tool(const any_flags::RowBlocks& rows, int i, std::size_t group) noexcept {
  const ContactNumbers tools = ContactNumbers::load(rows.tools + group * any_flags::contacts_at_once);
  return select(abs(tools - rows.tools[i]) < ContactNumbers(0.5), ContactNumbers(1.0), ContactNumbers(0.0));
}

/// The blocks of row i and a group of others, with the coupling.
PALPATE_ALWAYS_INLINE ContactBlock<ContactNumbers> coupled_blocks(const any_flags::RowBlocks& rows, int i,
                                                                  std::size_t group,
                                                                  const any_flags::CouplingCompliance& coupling,
                                                                  const ContactVector<double>& arm) noexcept {
  ContactBlock<ContactNumbers> block = load_blocks(rows.blocks, rows.first[i] + group);
  add_coupling(coupling, of_same_tool(rows, i, group), in_all_lanes(arm), load_vectors(rows.arms, group), block);
  return block;
}
PALPATE_ALWAYS_INLINE ContactBlock<double> coupled_diagonal(const any_flags::RowBlocks& rows, int i,
                                                            const any_flags::CouplingCompliance& coupling,
                                                            const ContactVector<double>& arm) noexcept {
  const double* const a = rows.diagonal + 9 * i;
  ContactBlock<double> block{a[0], a[1], a[2], a[3], a[4], a[5], a[6], a[7], a[8]};
  add_coupling(coupling, 1.0, arm, arm, block);
  return block;
}

inline void along_normals(const any_flags::RowBlocks& rows, int i, const any_flags::CouplingCompliance& coupling,
                          double* w) noexcept {
  const double* const normals = rows.axes[2];
  const ContactVector<double> normal = contact_vector(normals, i), arm = contact_vector(rows.arms, i);
  const ContactVector<ContactNumbers> own = in_all_lanes(normal);
  if (coupling.rotation > 0.0) {
    for (std::size_t g = 0; g < any_flags::contact_groups(i); ++g)
      dot(own, product(coupled_blocks(rows, i, g, coupling, arm), load_vectors(normals, g)))
          .store(w + g * any_flags::contacts_at_once);
  } else {
    for (std::size_t g = 0; g < any_flags::contact_groups(i); ++g) {
      const ContactVector<ContactNumbers> other = load_vectors(normals, g);
      const ContactVector<ContactNumbers> moved = product(load_blocks(rows.blocks, rows.first[i] + g), other);
      (dot(own, moved) + coupling.translation * of_same_tool(rows, i, g) * dot(own, other))
          .store(w + g * any_flags::contacts_at_once);
    }
  }
  w[i] = dot(normal, product(coupled_diagonal(rows, i, coupling, arm), normal));
}

inline void in_axes(const any_flags::RowBlocks& rows, int i, const any_flags::CouplingCompliance& coupling,
                    std::size_t stride, double* w) noexcept {
  const ContactVector<double> arm = contact_vector(rows.arms, i);
  const ContactVector<double> x = contact_vector(rows.axes[0], i), y = contact_vector(rows.axes[1], i),
                              z = contact_vector(rows.axes[2], i);
  for (std::size_t g = 0; g < any_flags::contact_groups(i); ++g) {
    const ContactBlock<ContactNumbers> block = coupled_blocks(rows, i, g, coupling, arm);
    double* to = w + g * any_flags::contacts_at_once;
    for (std::size_t b = 0; b < 3; ++b, to += stride) {
      const ContactVector<ContactNumbers> moved = product(block, load_vectors(rows.axes[b], g));
      dot(in_all_lanes(x), moved).store(to);
      dot(in_all_lanes(y), moved).store(to + 3 * stride);
      dot(in_all_lanes(z), moved).store(to + 6 * stride);
    }
  }
  const ContactBlock<double> block = coupled_diagonal(rows, i, coupling, arm);
  double* to = w + i;
  for (std::size_t b = 0; b < 3; ++b, to += stride) {
    const ContactVector<double> moved = product(block, contact_vector(rows.axes[b], i));
    to[0] = dot(x, moved), to[3 * stride] = dot(y, moved), to[6 * stride] = dot(z, moved);
  }
}

PALPATE_ALWAYS_INLINE double sum_of_lanes(const ContactNumbers& n) noexcept {
  double sum = 0.0;
  for (int l = 0; l < any_flags::contacts_at_once; ++l) sum += n[l];
  return sum;
}

inline void displace(const any_flags::RowBlocks& rows, int count, int loaded, const double* forces,
                     double* moved) noexcept {
  constexpr std::size_t lanes = any_flags::contacts_at_once;
  for (std::size_t k = 0; k < 3 * lanes * any_flags::contact_groups(count); ++k) moved[k] = 0.0;
  for (int i = 0; i < count; ++i) {
    const bool is_loaded = i < loaded;
    const ContactVector<double> force = is_loaded ? contact_vector(forces, i) : ContactVector<double>{0.0, 0.0, 0.0};
    const ContactVector<ContactNumbers> own = in_all_lanes(force);
    ContactVector<ContactNumbers> sum = in_all_lanes({0.0, 0.0, 0.0});
    for (std::size_t g = 0; g < any_flags::contact_groups(is_loaded ? i : loaded); ++g) {
      const ContactBlock<ContactNumbers> a = load_blocks(rows.blocks, rows.first[i] + g);
      const ContactVector<ContactNumbers> at_i = product(a, load_vectors(forces, g)), at_j = transposed_product(a, own);
      sum.x += at_i.x, sum.y += at_i.y, sum.z += at_i.z;
      double* const to = moved + 3 * g * lanes;
      (ContactNumbers::load(to) + at_j.x).store(to);
      (ContactNumbers::load(to + lanes) + at_j.y).store(to + lanes);
      (ContactNumbers::load(to + 2 * lanes) + at_j.z).store(to + 2 * lanes);
    }
    double* const total = rows.sums + 3 * i;
    total[0] = sum_of_lanes(sum.x), total[1] = sum_of_lanes(sum.y), total[2] = sum_of_lanes(sum.z);
    if (!is_loaded) continue;
    const double* const a = rows.diagonal + 9 * i;
    for (std::size_t c = 0; c < 3; ++c) total[c] += a[c] * force.x + a[3 + c] * force.y + a[6 + c] * force.z;
  }
  for (int i = 0; i < count; ++i)
    for (std::size_t c = 0; c < 3; ++c)
      moved[(3 * (static_cast<std::size_t>(i) / lanes) + c) * lanes + static_cast<std::size_t>(i) % lanes] +=
          rows.sums[static_cast<std::size_t>(3 * i) + c];
}

/// The step of half_space_support.
PALPATE_ALWAYS_INLINE ContactNumbers support_step(const ContactNumbers& at) noexcept {
  const ContactNumbers t = min(max(at, ContactNumbers(0.0)), ContactNumbers(1.0)), rest = 1.0 - t;
  return rest * rest * rest * (1.0 + t * (3.0 + 6.0 * t));
}

/// Vectors of a group of loads.
template <std::size_t First>
PALPATE_ALWAYS_INLINE ContactVector<ContactNumbers> load_half_space(const double* loads, std::size_t group) noexcept {
  constexpr std::size_t all = any_flags::half_space_numbers;
  return {load_contacts<all>(loads, group, First), load_contacts<all>(loads, group, First + 1),
          load_contacts<all>(loads, group, First + 2)};
}

/// The displacement of `supported_compliance` times the forces of a group of loads.
PALPATE_ALWAYS_INLINE void add_half_space_group(const double* loads, std::size_t group, const double* p,
                                                ContactVector<ContactNumbers>& sum) noexcept {
  using namespace any_flags;
  using Numbers = ContactNumbers;
  constexpr double rounding = 1e-9;
  const auto number = [&](std::size_t c) { return load_contacts<half_space_numbers>(loads, group, c); };
  const ContactVector<Numbers> from = load_half_space<half_space_position>(loads, group);
  const ContactVector<Numbers> d{p[0] - from.x, p[1] - from.y, p[2] - from.z};
  const Numbers edges = p[half_space_length] + number(half_space_length), square = edges * edges, squared = dot(d, d);
  if (!any(squared < 4.0 * square)) return;
  // Nothing of loads at the same place or on other bodies.
  const Numbers least_square = (rounding * rounding) * square;
  const auto apart = (least_square < squared) & (abs(number(half_space_body) - p[half_space_body]) < Numbers(0.5));
  const Numbers distance = sqrt(max(squared, least_square)), per_length = 1.0 / distance;
  const ContactVector<Numbers> normal =
      in_all_lanes({p[half_space_normal], p[half_space_normal + 1], p[half_space_normal + 2]});
  const ContactVector<Numbers> other = load_half_space<half_space_normal>(loads, group);
  const ContactVector<Numbers> force = load_half_space<half_space_force>(loads, group);
  const Numbers support =
      select(apart, support_step(distance / edges - 1.0) * support_step(-2.0 * dot(normal, other)), Numbers(0.0));
  const ContactVector<Numbers> n{0.5 * (normal.x + other.x), 0.5 * (normal.y + other.y), 0.5 * (normal.z + other.z)};
  const Numbers nu = 0.5 * (p[half_space_poisson_ratio] + number(half_space_poisson_ratio));
  const Numbers scale = support * p[half_space_root] * number(half_space_root) * per_length;
  const Numbers across = scale * (1.0 - 2.0 * nu) * per_length, along = dot(d, force);
  const Numbers of_d = 2.0 * scale * nu * per_length * per_length * along + across * dot(n, force);
  const Numbers of_force = 2.0 * scale * (1.0 - nu), of_n = across * along;
  sum.x += of_force * force.x + of_d * d.x - of_n * n.x;
  sum.y += of_force * force.y + of_d * d.y - of_n * n.y;
  sum.z += of_force * force.z + of_d * d.z - of_n * n.z;
}

inline void add_half_space(const double* loads, int count, const double* point, double* u) noexcept {
  ContactVector<ContactNumbers> sum = in_all_lanes({0.0, 0.0, 0.0});
  for (std::size_t g = 0; g < any_flags::contact_groups(count); ++g) add_half_space_group(loads, g, point, sum);
  u[0] += sum_of_lanes(sum.x), u[1] += sum_of_lanes(sum.y), u[2] += sum_of_lanes(sum.z);
}

inline constexpr any_flags::ContactKernels contacts_here{along_normals, in_axes, displace, add_half_space};

}}}  // namespace palpate::detail
