// Rules on the unit triangle (0, e1, e2), area 1/2.
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

}}  // namespace palpate
