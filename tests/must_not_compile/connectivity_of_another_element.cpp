// expect: MeshOf
// Connectivity of an old mesh with eight nodes per element.
#include <palpate/element/tet4.hpp>
#include <palpate/mesh/mesh.hpp>

using namespace palpate;

struct OldMesh {
#ifdef PALPATE_GOOD_TWIN
  static constexpr int nodes_per_element = 4;
#else
  static constexpr int nodes_per_element = 8;
#endif
  Index node_count() const;
  Index element_count() const;
  Vector3 position(Index) const;
  Index element_node(Index, int) const;
  int region(Index) const;
  int region_count() const;
  std::string region_name(int) const;
  const Group* find_group(std::string_view) const;
};

Mesh<Tet4> own(const OldMesh& old) {
  return copy_mesh<Tet4>(old);
}
