// Doubles that one instruction processes together, and sums over columns of doubles.
#pragma once

#include <palpate/core/types.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// The doubles of one register; their number depends on the compiler flags.
using Packet = Eigen::internal::packet_traits<double>::type;
inline constexpr int packet_size = Eigen::internal::packet_traits<double>::size;
inline Packet load(const double* p) noexcept {
  return Eigen::internal::ploadu<Packet>(p);
}
inline void store(double* p, const Packet& x) noexcept {
  Eigen::internal::pstoreu(p, x);
}
inline Packet broadcast(double x) noexcept {
  return Eigen::internal::pset1<Packet>(x);
}
/// a b + c
inline Packet multiply_add(const Packet& a, const Packet& b, const Packet& c) noexcept {
  return Eigen::internal::pmadd(a, b, c);
}

/// The packet of a number type. Of floats at most eight, so that a column padded to eight rows is a whole number of
/// packets.
template <class T>
struct PacketOf {
  using type = Packet;
  static constexpr int size = packet_size;
};
template <bool Halved>
struct FloatPacket {
  using type = Eigen::internal::packet_traits<float>::type;
};
template <>
struct FloatPacket<true> {
  using type = Eigen::internal::packet_traits<float>::half;
};
template <>
struct PacketOf<float> {
  static constexpr int whole = Eigen::internal::packet_traits<float>::size;
  using type = FloatPacket<(whole > 8)>::type;
  static constexpr int size = whole > 8 ? 8 : whole;
};
inline PacketOf<float>::type load(const float* p) noexcept {
  return Eigen::internal::ploadu<PacketOf<float>::type>(p);
}
inline void store(float* p, const PacketOf<float>::type& x) noexcept {
  Eigen::internal::pstoreu(p, x);
}
inline PacketOf<float>::type broadcast(float x) noexcept {
  return Eigen::internal::pset1<PacketOf<float>::type>(x);
}
inline PacketOf<float>::type multiply_add(const PacketOf<float>::type& a, const PacketOf<float>::type& b,
                                          const PacketOf<float>::type& c) noexcept {
  return Eigen::internal::pmadd(a, b, c);
}

/// y += sum_k v[k] c[k] with four columns of n doubles: y is read and written once.
inline void add_columns(double* y, const std::array<const double*, 4>& c, const std::array<double, 4>& v,
                        int n) noexcept {
  const Packet v0 = broadcast(v[0]), v1 = broadcast(v[1]), v2 = broadcast(v[2]), v3 = broadcast(v[3]);
  int i = 0;
  for (; i + packet_size <= n; i += packet_size) {
    const Packet sum = multiply_add(v1, load(c[1] + i), multiply_add(v0, load(c[0] + i), load(y + i)));
    store(y + i, multiply_add(v3, load(c[3] + i), multiply_add(v2, load(c[2] + i), sum)));
  }
  for (; i < n; ++i) y[i] += v[0] * c[0][i] + v[1] * c[1][i] + v[2] * c[2][i] + v[3] * c[3][i];
}

/// The sum of x[i] y[i].
inline double dot(const double* x, const double* y, int n) noexcept {
  Packet even = broadcast(0.0), odd = even;
  int i = 0;
  for (; i + 2 * packet_size <= n; i += 2 * packet_size) {
    even = multiply_add(load(x + i), load(y + i), even);
    odd = multiply_add(load(x + i + packet_size), load(y + i + packet_size), odd);
  }
  double sum = Eigen::internal::predux(Eigen::internal::padd(even, odd));
  for (; i < n; ++i) sum += x[i] * y[i];
  return sum;
}

}}}  // namespace palpate::detail
