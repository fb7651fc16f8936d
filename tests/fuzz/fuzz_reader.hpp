// Shared by all fuzz targets: reads a text, and aborts the program unless the result is a SetupError or a valid mesh.
#pragma once

#include <palpate/element/tet4.hpp>
#include <palpate/io/read_mesh.hpp>

#include <cstdlib>
#include <span>

namespace fuzz {

inline void require(bool is_sound) {
  if (!is_sound) std::abort();
}

/// Aborts unless positions are finite and all ids are in range.
inline void require_sound(const palpate::Mesh<palpate::Tet4>& mesh) {
  const auto n = mesh.node_count(), m = mesh.element_count();
  require(n > 0 && m > 0 && mesh.regions.size() == mesh.elements.size());
  for (const auto& x : mesh.positions) require(x.allFinite());
  for (const auto& element : mesh.elements)
    for (const auto i : element) require(i >= 0 && i < n);
  for (const int r : mesh.regions) require(r >= 0 && r < mesh.region_count());
  for (const palpate::Group& g : mesh.groups.all()) {
    for (const auto i : g.nodes) require(i >= 0 && i < n);
    for (const auto e : g.elements) require(e >= 0 && e < m);
    for (const auto& face : g.faces) {
      require(face.size() == 3);
      for (const auto i : face) require(i >= 0 && i < n);
    }
  }
}

/// Calls `parse`, which returns a FileMesh, builds the mesh and checks it.
template <class Parse>
int run(Parse&& parse) {
  palpate::Mesh<palpate::Tet4> mesh;
  try {
    palpate::io::MeshNumbering ids;
    mesh = palpate::io::build_mesh<palpate::Tet4>(parse(), 1e-3, &ids);
    require(static_cast<palpate::Index>(ids.node_tags.size()) == mesh.node_count());
    require(static_cast<palpate::Index>(ids.element_tags.size()) == mesh.element_count());
  } catch (const palpate::SetupError&) {
    return 0;
  }
  require_sound(mesh);
  return 0;
}

/// Removes the part up to the next byte 0x1F from `text` and returns it: several files in one input.
inline std::string_view cut(std::string_view& text) {
  const std::size_t end = text.find('\x1f');
  const std::string_view first = text.substr(0, end);
  text.remove_prefix(end == text.npos ? text.size() : end + 1);
  return first;
}

inline std::string_view text_of(const std::uint8_t* data, std::size_t size) {
  return {reinterpret_cast<const char*>(data), size};
}

}  // namespace fuzz
