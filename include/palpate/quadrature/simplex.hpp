// Rules on the unit triangle (0, e1, e2), area 1/2, and the unit tetrahedron (0, e1, e2, e3), volume 1/6.
#pragma once

#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI {

/// Rule exact to `Degree`, all weights positive. Degrees 1, 2, 4 and 5 exist.
template <int Degree>
struct TriangleRule;

template <>
struct TriangleRule<1> {
  static constexpr int dimension = 2, degree = 1;
  static constexpr std::array<QuadraturePoint<2>, 1> points{{{{1.0 / 3.0, 1.0 / 3.0}, 0.5}}};
};

template <>
struct TriangleRule<2> {
  static constexpr int dimension = 2, degree = 2;
  static constexpr double a = 1.0 / 6.0, b = 2.0 / 3.0;
  static constexpr std::array<QuadraturePoint<2>, 3> points{{{{a, a}, a}, {{b, a}, a}, {{a, b}, a}}};
};

/// Six points (Dunavant 1985).
template <>
struct TriangleRule<4> {
  static constexpr int dimension = 2, degree = 4;
  static constexpr double a = 0.44594849091596488632, a2 = 1.0 - 2.0 * a, wa = 0.22338158967801146570 / 2.0;
  static constexpr double b = 0.091576213509770743460, b2 = 1.0 - 2.0 * b, wb = 0.10995174365532186764 / 2.0;
  static constexpr std::array<QuadraturePoint<2>, 6> points{
      {{{a, a}, wa}, {{a2, a}, wa}, {{a, a2}, wa}, {{b, b}, wb}, {{b2, b}, wb}, {{b, b2}, wb}}};
};

/// Seven points (Radon 1948): coordinates (6 -+ sqrt 15)/21, weights (155 -+ sqrt 15)/2400 and 9/80.
template <>
struct TriangleRule<5> {
  static constexpr int dimension = 2, degree = 5;
  static constexpr double a = 0.10128650732345633880, a2 = 1.0 - 2.0 * a, wa = 0.12593918054482715260 / 2.0;
  static constexpr double b = 0.47014206410511508977, b2 = 1.0 - 2.0 * b, wb = 0.13239415278850618074 / 2.0;
  static constexpr std::array<QuadraturePoint<2>, 7> points{{{{1.0 / 3.0, 1.0 / 3.0}, 9.0 / 80.0},
                                                             {{a, a}, wa},
                                                             {{a2, a}, wa},
                                                             {{a, a2}, wa},
                                                             {{b, b}, wb},
                                                             {{b2, b}, wb},
                                                             {{b, b2}, wb}}};
};

/// Rule exact to `Degree`. Degrees 1, 2, 3 and 5 exist. Degree 3 has one negative weight.
template <int Degree>
struct TetrahedronRule;

/// Centroid, weight 1/6. (The thesis prints weight 2 per axis = 8, the volume of a cube; see docs/thesis.md.)
template <>
struct TetrahedronRule<1> {
  static constexpr int dimension = 3, degree = 1;
  static constexpr std::array<QuadraturePoint<3>, 1> points{{{{0.25, 0.25, 0.25}, 1.0 / 6.0}}};
};

/// Four points, coordinates (5 -+ sqrt 5)/20 (Hammer, Marlowe and Stroud 1956).
template <>
struct TetrahedronRule<2> {
  static constexpr int dimension = 3, degree = 2;
  static constexpr double a = 0.13819660112501051518, b = 0.58541019662496845446;
  static constexpr std::array<QuadraturePoint<3>, 4> points{
      {{{a, a, a}, 1.0 / 24.0}, {{b, a, a}, 1.0 / 24.0}, {{a, b, a}, 1.0 / 24.0}, {{a, a, b}, 1.0 / 24.0}}};
};

/// Five points, the centroid with weight -4/5 of the volume (Hammer and Stroud 1958).
template <>
struct TetrahedronRule<3> {
  static constexpr int dimension = 3, degree = 3;
  static constexpr double a = 1.0 / 6.0, b = 0.5, w = 9.0 / 120.0;
  static constexpr std::array<QuadraturePoint<3>, 5> points{
      {{{0.25, 0.25, 0.25}, -4.0 / 30.0}, {{a, a, a}, w}, {{b, a, a}, w}, {{a, b, a}, w}, {{a, a, b}, w}}};
};

/// Fourteen points, all weights positive (Walkington 2000).
template <>
struct TetrahedronRule<5> {
  static constexpr int dimension = 3, degree = 5;
  static constexpr double a = 0.31088591926330060980, a3 = 1.0 - 3.0 * a, wa = 0.11268792571801585080 / 6.0;
  static constexpr double b = 0.092735250310891226402, b3 = 1.0 - 3.0 * b, wb = 0.073493043116361949544 / 6.0;
  static constexpr double c = 0.045503704125649649492, d = 0.5 - c, wc = 0.042546020777081466438 / 6.0;
  static constexpr std::array<QuadraturePoint<3>, 14> points{{{{a, a, a}, wa},
                                                              {{a3, a, a}, wa},
                                                              {{a, a3, a}, wa},
                                                              {{a, a, a3}, wa},
                                                              {{b, b, b}, wb},
                                                              {{b3, b, b}, wb},
                                                              {{b, b3, b}, wb},
                                                              {{b, b, b3}, wb},
                                                              {{c, c, d}, wc},
                                                              {{c, d, c}, wc},
                                                              {{d, c, c}, wc},
                                                              {{c, d, d}, wc},
                                                              {{d, c, d}, wc},
                                                              {{d, d, c}, wc}}};
};

}}  // namespace palpate
