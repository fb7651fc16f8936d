// Where the vertices of the contact surface are under the forces of the tools.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/contact/contact_surface.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Forces on vertices, and the displacement of any vertex under them, computed when asked for and remembered until the
/// forces change. `Capacity` bounds the number of loaded vertices.
template <int Capacity>
class SurfaceDisplacement {
 public:
  /// Allocates for a surface; for set-up.
  explicit SurfaceDisplacement(int vertices)
      : displacement_(static_cast<std::size_t>(vertices)), stamp_(static_cast<std::size_t>(vertices), 0) {}

  std::span<const VertexForce> forces() const noexcept { return {forces_.data(), static_cast<std::size_t>(count_)}; }

  /// Forgets remembered displacements when the tissue's compliance is another than in the last tick.
  void begin_tick(std::uint64_t revision) noexcept {
    if (revision != std::exchange(revision_, revision)) ++generation_;
  }

  /// Goes on on a surface with the same numbers of vertices, and more, that `fresh` was made for. No allocation.
  void move_to(SurfaceDisplacement& fresh) noexcept {
    displacement_.swap(fresh.displacement_);
    stamp_.swap(fresh.stamp_);
    ++generation_;
  }

  void clear() noexcept {
    count_ = 0;
    ++generation_;
  }
  /// Adds a force on a vertex, which `slot` remembers between calls (start: -1).
  void add(int vertex, const Vector3& force, int& slot) noexcept {
    if (slot < 0) {
      slot = count_;
      forces_[static_cast<std::size_t>(count_++)] = {vertex, Vector3::Zero()};
    }
    forces_[static_cast<std::size_t>(slot)].force += force;
  }

  /// Displacement of a vertex under the forces [m].
  template <TissueModel Tissue>
  const Vector3& at(const Tissue& tissue, int vertex) noexcept {
    const auto i = static_cast<std::size_t>(vertex);
    if (stamp_[i] != generation_) {
      stamp_[i] = generation_;
      Vector3 u = Vector3::Zero();
      for (const VertexForce& f : forces()) u.noalias() += tissue.compliance(vertex, f.vertex) * f.force;
      displacement_[i] = u;
    }
    return displacement_[i];
  }
  template <TissueModel Tissue>
  Vector3 position(const Tissue& tissue, int vertex) noexcept {
    return tissue.contact_surface().position(vertex) + at(tissue, vertex);
  }

  /// How far the forces move the surface near them [m]: the lesser of a bound that holds everywhere and of twice what
  /// the loaded vertices move. The latter is no bound for a part that swings about another; `Candidates` looks for
  /// such.
  template <TissueModel Tissue>
  double reach(const Tissue& tissue) noexcept {
    double bounded = 0.0, loaded = 0.0;
    for (const VertexForce& f : forces()) {
      bounded += tissue.compliance_bound(f.vertex) * f.force.norm();
      loaded = std::max(loaded, at(tissue, f.vertex).norm());
    }
    return std::min(bounded, 2.0 * loaded);
  }

 private:
  std::array<VertexForce, static_cast<std::size_t>(Capacity)> forces_{};
  int count_ = 0;
  std::vector<Vector3> displacement_;
  std::vector<std::uint64_t> stamp_;
  std::uint64_t generation_ = 1, revision_ = 0;
};

}}  // namespace palpate
