// The mesh of a C program, before an element is chosen.
#pragma once

#include <palpate/core/types.hpp>
#include <palpate/io/read_mesh.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/mesh/mesh_ref.hpp>

#include <optional>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// A parsed file or copied arrays, with groups that were added.
struct GivenMesh {
  std::optional<io::FileMesh> file;
  double scale = 1.0;                ///< of a file
  palpate::detail::PlainMesh plain;  ///< without a file
  int nodes_per_cell = 0;            ///< of `plain`
  GroupTable groups;                 ///< added by name

  Index node_count() const noexcept;
  Vector3 position(Index i) const noexcept;  ///< [m]
};

/// Throws unsupported when the cells have another number of nodes.
void require_nodes_per_cell(const GivenMesh& given, int nodes);

/// As a mesh of E. Throws unsupported, or what reading throws.
template <Element E>
Mesh<E> mesh_of(const GivenMesh& given) {
  Mesh<E> mesh;
  if (given.file) {
    mesh = io::build_mesh<E>(*given.file, given.scale, nullptr);
  } else {
    require_nodes_per_cell(given, E::nodes);
    mesh = to_mesh<E>(palpate::detail::PlainMesh(given.plain));
  }
  for (const Group& added : given.groups.all()) {
    Group& group = mesh.groups.get_or_add(added.name, 0);
    group.nodes.insert(group.nodes.end(), added.nodes.begin(), added.nodes.end());
  }
  mesh.groups.tidy();
  return mesh;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
