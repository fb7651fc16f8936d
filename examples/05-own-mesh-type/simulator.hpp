// The mesh class of a simulator, made readable for palpate without a copy.
#pragma once

#include <palpate/concepts/mesh.hpp>

namespace own {

using palpate::Group;
using palpate::Index;
using palpate::Vector3;

/// A particle of the simulator, with more data than palpate needs.
struct Particle {
  double x, y, z;       ///< [mm]
  double vx, vy, vz;    ///< [mm/s]
  double inverse_mass;  ///< [1/kg]
};

/// A tetrahedron of the simulator; `tissue` counts from zero.
struct Cell {
  unsigned particle[4];
  unsigned short tissue;
};

/// The class of the simulator. palpate requires the eight short functions below the line, which read the data in place.
/// They also convert units: the simulator uses millimetres.
class SimulatorBody {
 public:
  std::vector<Particle> particles;
  std::vector<Cell> cells;
  std::vector<std::string> tissues;
  std::vector<Group>
      sets;  ///< palpate's type for named sets; a simulator with its own type keeps a table of these in addition

  // --- MeshView
  static constexpr int nodes_per_element = 4;
  Index node_count() const { return static_cast<Index>(particles.size()); }
  Index element_count() const { return static_cast<Index>(cells.size()); }
  Vector3 position(Index i) const {
    const Particle& p = particles[static_cast<std::size_t>(i)];
    return Vector3(p.x, p.y, p.z) / 1000.0;
  }
  Index element_node(Index e, int a) const { return cells[static_cast<std::size_t>(e)].particle[a]; }
  int region(Index e) const { return cells[static_cast<std::size_t>(e)].tissue; }
  int region_count() const { return static_cast<int>(tissues.size()); }
  const std::string& region_name(int r) const { return tissues[static_cast<std::size_t>(r)]; }
  const Group* find_group(std::string_view name) const {
    for (const Group& g : sets)
      if (g.name == name) return &g;
    return nullptr;
  }
};

static_assert(palpate::MeshView<SimulatorBody>);

}  // namespace own
