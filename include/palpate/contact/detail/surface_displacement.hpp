// Where the vertices of the contact surface are under the forces of the tools.
#pragma once

#include <palpate/contact/tissue_view.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Forces on vertices, and the displacement of any vertex under them, computed when asked for and remembered until the
/// forces change.
class SurfaceDisplacement {
 public:
  /// Allocates for a surface and for `capacity` loaded vertices; for set-up.
  SurfaceDisplacement(int vertices, int capacity);

  std::span<const VertexForce> forces() const noexcept { return {forces_.data(), static_cast<std::size_t>(count_)}; }

  /// Forgets remembered displacements when the tissue's compliance is another than in the last tick.
  void begin_tick(std::uint64_t revision) noexcept;
  /// Goes on on a surface with the same numbers of vertices, and more, that `fresh` was made for. No allocation.
  void move_to(SurfaceDisplacement& fresh) noexcept;
  void clear() noexcept {
    count_ = 0;
    ++generation_;
  }
  /// Adds a force on a vertex, which `slot` remembers between calls (start: -1).
  void add(int vertex, const Vector3& force, int& slot) noexcept;

  /// Displacement of a vertex under the forces [m].
  const Vector3& at(const TissueView& tissue, int vertex) noexcept {
    const auto i = static_cast<std::size_t>(vertex);
    if (stamp_[i] != generation_) {
      stamp_[i] = generation_;
      tissue.displacement(vertex, forces(), displacement_[i]);
    }
    return displacement_[i];
  }
  /// Where it is [m].
  Vector3 position(const TissueView& tissue, int vertex) noexcept;

  /// How far the forces move the surface near them [m]: the lesser of a bound that holds everywhere and of twice what
  /// the loaded vertices move. The latter is no bound for a part that swings about another; `Candidates` looks for
  /// such.
  double reach(const TissueView& tissue) noexcept;

 private:
  std::vector<VertexForce> forces_;
  int count_ = 0;
  std::vector<Vector3> displacement_;
  std::vector<std::uint64_t> stamp_;
  std::uint64_t generation_ = 1, revision_ = 0;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/surface_displacement.ipp>
#endif
