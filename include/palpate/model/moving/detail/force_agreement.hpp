// Whether the contact forces of ticks and steps agree.
#pragma once

#include <palpate/concepts/vertex_force.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/detail/contact_springs.hpp>

#include <algorithm>
#include <cmath>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Whether ticks and steps find the same contact forces, all tools together. A tick that takes the tissue for stiffer
/// than it is finds too large a change of force, and the next step reverses it: forces alternate. The springs between
/// tools and tissue (ContactSprings) damp this. Their usual stiffness is that of a uniform pressure. Where the tissue
/// is soft under pressures that differ from point to point (a stretched surface close to wrinkling, short steps with
/// inertia), they must be stiffer. Much stiffer ones throw the surface off the tool in short steps with inertia. Only
/// the constructor allocates.
class ForceAgreement {
 public:
  ForceAgreement() = default;
  explicit ForceAgreement(std::size_t vertices) : force_(vertices, Vector3::Zero()) {
    change_ = next_ = differed_ = force_;
  }

  void clear() noexcept;
  /// The forces of a new tick, of all tools. O(vertices).
  void add(std::span<const VertexForce> forces) noexcept;
  /// Energies of the difference between these forces and those that the step has found, and of the forces. With
  /// friction a difference stays until the forces have changed: points may have slipped too far, or too little.
  void compare(double difference, double all, bool has_friction) noexcept;

  /// Stiffness that the springs need together, relative to the tissue under them.
  double spring_stiffness() const noexcept { return stiffness_; }
  /// Whether the difference is more than 7 % of the forces, by the roots of the energies.
  bool is_poor() const noexcept { return remembered_ > 0.07 * all_; }

 private:
  static constexpr double softest = ContactSprings::usual_stiffness, stiffest = 7.0;

  std::vector<Vector3> force_, change_, next_;  // per vertex
  std::vector<Vector3> differed_;               // the forces of the tick that differed most
  double last_ = 0.0;                           // sum of the squares of change_
  // Roots of energies:
  double all_ = 0.0;         // of the forces
  double difference_ = 0.0;  // of the difference between that tick and its step
  double remembered_ = 0.0;  // what is left of it
  double stiffness_ = softest;
};

inline void ForceAgreement::clear() noexcept {
  std::ranges::fill(force_, Vector3::Zero());
  std::ranges::fill(change_, Vector3::Zero());
  last_ = all_ = difference_ = remembered_ = 0.0;
  stiffness_ = softest;
}

inline void ForceAgreement::add(std::span<const VertexForce> forces) noexcept {
  constexpr double back = 0.3, growth = 0.5;  // cosine of a change that goes back, its square relative to the last one
  constexpr double noticed = 1e-5;            // square of a change, relative to the forces
  constexpr double stiffer = 1.3, softer = 0.98;  // per step
  constexpr double forgotten = 0.7;               // part of a difference, when the forces have changed by their size
  if (forces.empty()) all_ = difference_ = remembered_ = 0.0;
  double product = 0.0, change = 0.0, size = 0.0, away = 0.0;
  std::ranges::fill(next_, Vector3::Zero());
  for (const VertexForce& f : forces) next_[static_cast<std::size_t>(f.vertex)] += f.force.in_model_axes();
  for (std::size_t i = 0; i < next_.size(); ++i) {
    const Vector3 now = next_[i] - force_[i];
    product += now.dot(change_[i]);
    change += now.squaredNorm();
    size += next_[i].squaredNorm();
    away += (next_[i] - differed_[i]).squaredNorm();
    change_[i] = now;
  }
  force_.swap(next_);
  const bool goes_back = product < -back * std::sqrt(change * last_) && change > growth * last_;
  stiffness_ = goes_back && change > noticed * size ? std::min(stiffest, stiffer * stiffness_)
                                                    : std::max(softest, softer * stiffness_);
  last_ = change;
  if (remembered_ > 0.0)
    remembered_ = std::min(remembered_, difference_ * std::max(0.0, 1.0 - forgotten * std::sqrt(away / size)));
}

inline void ForceAgreement::compare(double difference, double all, bool has_friction) noexcept {
  all_ = std::sqrt(std::max(0.0, all));
  const double found = std::sqrt(std::max(0.0, difference));
  if (has_friction && !(found > remembered_)) return;
  difference_ = remembered_ = found;
  std::ranges::copy(force_, differed_.begin());
}

}}}  // namespace palpate::detail
