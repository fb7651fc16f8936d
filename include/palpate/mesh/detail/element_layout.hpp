// An element type described by plain numbers, for code that works on meshes of any element type.
#pragma once

#include <palpate/concepts/element.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A kind of face of an element. Its triangles are those of TriangulatedFace; there are none if tools cannot touch it.
struct FaceLayout {
  int nodes = 0;  ///< 0 if the element has no such faces
  int triangle_count = 0;
  const std::array<int, 3>* triangles = nullptr;
};

/// The properties of an element type that mesh code needs. `element_layout<E>` is the one of E; it refers to constants
/// only and may be copied freely.
struct ElementLayout {
  int nodes = 0;                                        ///< of an element
  int order = 0;                                        ///< polynomial degree reproduced exactly
  int face_count = 0;                                   ///< of an element
  FaceLayout face, small_face;                          ///< small_face.nodes is 0 if all faces are of one kind
  const int* faces = nullptr;                           ///< face.nodes local nodes per face, outward; see Element
  void (*reference_nodes)(double*) noexcept = nullptr;  ///< writes x y z of every node

  /// The kind of a face with that many nodes.
  constexpr const FaceLayout& face_of(std::size_t count) const noexcept {
    return static_cast<int>(count) == small_face.nodes ? small_face : face;
  }
  /// Whether the element has faces with that many nodes.
  constexpr bool is_face_size(std::size_t count) const noexcept {
    return count > 0 && static_cast<int>(count) == face_of(count).nodes;
  }

  /// Local nodes of face f.
  constexpr std::span<const int> local_face(int f) const noexcept {
    const int* first = faces + f * face.nodes;
    const bool is_small = small_face.nodes > 0 && first[face.nodes - 1] < 0;
    return {first, static_cast<std::size_t>(is_small ? small_face.nodes : face.nodes)};
  }
};

/// E::faces, concatenated.
template <Element E>
inline constexpr auto flat_faces = [] {
  std::array<int, E::faces.size() * static_cast<std::size_t>(E::Face::nodes)> flat{};
  std::size_t k = 0;
  for (const auto& face : E::faces)
    for (const int a : face) flat[k++] = a;
  return flat;
}();

template <FaceElement F>
constexpr FaceLayout face_layout() noexcept {
  if constexpr (TriangulatedFace<F>)
    return {F::nodes, static_cast<int>(F::triangles.size()), F::triangles.data()};
  else
    return {F::nodes, 0, nullptr};
}

template <Element E>
constexpr FaceLayout small_face_layout() noexcept {
  if constexpr (HasSmallFace<E>)
    return face_layout<typename E::SmallFace>();
  else
    return {};
}

template <Element E>
void write_reference_nodes(double* xyz) noexcept {
  const auto x = E::reference_nodes();
  for (int a = 0; a < E::nodes; ++a)
    for (int c = 0; c < 3; ++c) xyz[3 * a + c] = x.coeff(a, c);
}

/// The layout of element E.
template <Element E>
inline constexpr ElementLayout element_layout{E::nodes,
                                              E::order,
                                              static_cast<int>(E::faces.size()),
                                              face_layout<typename E::Face>(),
                                              small_face_layout<E>(),
                                              flat_faces<E>.data(),
                                              &write_reference_nodes<E>};

}}}  // namespace palpate::detail
