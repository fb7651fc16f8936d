// Energy and force of a body that is cut.
#pragma once

#include <palpate/assembly/detail/energy_forces.hpp>
#include <palpate/assembly/hyperelastic_body.hpp>
#include <palpate/assembly/smoothed_tetrahedra.hpp>
#include <palpate/cut/detail/cut_topology.hpp>
#include <palpate/element/smoothed.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/model/moving/quasi_newton.hpp>

#include <memory>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

/// The forces of the elements that a cut leaves, evaluated again after every cut.
template <Element E, HyperelasticMaterial M, class S>
class CutForces {
 public:
  /// Whether elements have the ids of the body before any cut.
  static constexpr bool keeps_ids = false;

  /// Those after a cut; `rest` has the elements that are left. Throws as make_energy_forces.
  CutForces after(const CutTopology<E>&, HyperelasticBody<E, M> rest, const SetupLimits& limits) const {
    CutForces made;
    made.made_ = detail::make_energy_forces<S>(std::move(rest), limits);
    return made;
  }
  /// For a motion.
  std::unique_ptr<EnergyForces> take() noexcept { return std::move(made_); }

 private:
  std::unique_ptr<EnergyForces> made_;
};

/// Smoothed tetrahedra: those before the cut, copied and updated. The owner of the forces must outlive it.
template <HyperelasticMaterial M, class S>
class CutForces<Smoothed<Tet4>, M, S> {
 public:
  static constexpr bool keeps_ids = true;
  using Force = SmoothedTetrahedra<M, S>;
  using Owner = BatchedEnergyForces<Force, S>;

  CutForces after(const CutTopology<Smoothed<Tet4>>& topology, HyperelasticBody<Smoothed<Tet4>, M> rest,
                  const SetupLimits& limits) const {
    CutForces made;
    if (used_ == nullptr) {
      made.made_ = std::make_unique<Owner>(Force(rest, limits));
    } else {
      Force force = used_->force();
      force.follow(topology.mesh(), [&](Index e) { return topology.state(e) != ElementState::supported; });
      made.made_ = std::make_unique<Owner>(std::move(force));
    }
    made.used_ = made.made_.get();
    return made;
  }
  std::unique_ptr<EnergyForces> take() noexcept { return std::move(made_); }

 private:
  std::unique_ptr<Owner> made_;
  const Owner* used_ = nullptr;  // null before the first
};

}}  // namespace palpate
