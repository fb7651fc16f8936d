// The names and node orders Gmsh has for the elements of the library.
#pragma once

#include <palpate/element/hex20.hpp>
#include <palpate/element/mean_dilatation.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/with_quadrature.hpp>

namespace palpate::inline PALPATE_ABI::io {

/// What Gmsh calls element E: its type number, that of its faces, and `order[a]`, the place in Gmsh's node list of E's
/// node a. Specialise it to read another element.
template <class E>
struct GmshElement;

template <>
struct GmshElement<Tet4> {
  static constexpr int type = 4;
  static constexpr int face_type = 2;
  static constexpr std::array<int, 4> order{0, 1, 2, 3};
};
template <>
struct GmshElement<Tet10> {
  static constexpr int type = 11;
  static constexpr int face_type = 9;
  static constexpr std::array<int, 10> order{0, 1, 2, 3, 4, 5, 6, 7, 9, 8};
};
template <>
struct GmshElement<Hex8> {
  static constexpr int type = 5;
  static constexpr int face_type = 3;
  static constexpr std::array<int, 8> order{0, 1, 2, 3, 4, 5, 6, 7};
};
template <>
struct GmshElement<Hex20> {
  static constexpr int type = 17;
  static constexpr int face_type = 16;
  static constexpr std::array<int, 20> order{0, 1,  2,  3, 4,  5,  6,  7,  8,  11,
                                             13, 9, 16, 18, 19, 17, 10, 12, 14, 15};
};
template <class E, class Rule>
struct GmshElement<WithQuadrature<E, Rule>> : GmshElement<E> {};
template <class E>
struct GmshElement<MeanDilatation<E>> : GmshElement<E> {};

}  // namespace palpate::inline PALPATE_ABI::io
