// A mesh whose ids change at admission.
#pragma once

#include <palpate/mesh/mesh.hpp>

namespace test {

using namespace palpate;

/// The mesh with an orphan node (used by no element) in front of all others.
template <class E>
Mesh<E> with_orphan_in_front(Mesh<E> mesh, const Vector3& orphan) {
  mesh.positions.insert(mesh.positions.begin(), orphan);
  for (auto& element : mesh.elements)
    for (NodeId& i : element) ++i;
  for (Group& g : mesh.groups.all()) {
    for (NodeId& i : g.nodes) ++i;
    for (auto& face : g.faces)
      for (NodeId& i : face) ++i;
  }
  return mesh;
}

}  // namespace test
