// Energy and force of an elastic body, for methods that need no tangent.
#pragma once

#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Parts of a computed energy [J] and of the norm of computed forces f [N] that are due to rounding; with the inverse H
/// of a step also of their energy f.Hf [J] and displacement Hf [m].
struct RoundingErrors {
  double energy = 0.0, force = 0.0, work = 0.0, displacement = 0.0;
};

/// Energy and force of a body at a displacement u, all dofs, 3 per node [m], in one call. Virtual, so that code that
/// uses it is compiled once for all elements and materials. No allocation.
class EnergyForces {
 public:
  virtual ~EnergyForces() = default;

  virtual Index size() const noexcept = 0;  ///< dofs
  /// Returns the stored energy [J], infinite where a material is not admissible, and sets f to its derivative [N].
  virtual double evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept = 0;
  /// Relative rounding error of the energy.
  virtual double rounding() const noexcept = 0;
  /// Energy [J] and forces f [N] of the body rotated as a whole, by u [m]: all of it is due to rounding. The energy is
  /// the largest of some rotations, since errors of elements may cancel; u and f are of the last. Nodes at `positions`
  /// [m].
  virtual double evaluate_rotated(const std::vector<Vector3>& positions, VectorX& u, VectorX& f) noexcept;

  /// Whether the forces depend on earlier steps. Then `begin_step` and `end_step` are as in ElasticForces.
  virtual bool has_history() const noexcept { return false; }
  virtual void begin_step(double) noexcept {}
  virtual void end_step(const VectorX&) noexcept {}
};

/// A force that computes energy and force together in scalar type S, for example SmoothedTetrahedra.
template <class Force, class S>
class BatchedEnergyForces final : public EnergyForces {
 public:
  explicit BatchedEnergyForces(Force force) : force_(std::move(force)) {}
  Index size() const noexcept override { return force_.size(); }
  double evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept override {
    return force_.evaluate(u, f, report);
  }
  double rounding() const noexcept override { return static_cast<double>(std::numeric_limits<S>::epsilon()); }
  const Force& force() const noexcept { return force_; }

 private:
  Force force_;
};

/// A body with a tangent, which is not used.
class TangentEnergyForces final : public EnergyForces {
 public:
  TangentEnergyForces(std::unique_ptr<ElasticForces> elastic, bool has_history)
      : elastic_(std::move(elastic)), has_history_(has_history) {}
  Index size() const noexcept override { return elastic_->size(); }
  double evaluate(const VectorX& u, VectorX& f, DeformationReport& report) noexcept override {
    report = elastic_->force(u, f);
    return report.admissible ? elastic_->energy(u) : infinity;
  }
  double rounding() const noexcept override { return std::numeric_limits<double>::epsilon(); }
  bool has_history() const noexcept override { return has_history_; }
  void begin_step(double dt) noexcept override { elastic_->begin_step(dt); }
  void end_step(const VectorX& u) noexcept override { elastic_->end_step(u); }

 private:
  std::unique_ptr<ElasticForces> elastic_;
  bool has_history_;
};

inline double EnergyForces::evaluate_rotated(const std::vector<Vector3>& positions, VectorX& u, VectorX& f) noexcept {
  Matrix3 diagonal, vertical;  // by 60 degrees about (1, 1, 1), by 90 about z
  diagonal << 2.0, -1.0, 2.0, 2.0, 2.0, -1.0, -1.0, 2.0, 2.0;
  vertical << 0.0, 1.0, 0.0, -1.0, 0.0, 0.0, 0.0, 0.0, 1.0;
  diagonal /= 3.0;
  double largest = 0.0;
  for (const Matrix3& turn :
       {Matrix3(diagonal * diagonal), Matrix3(diagonal * vertical), Matrix3(vertical * diagonal), vertical, diagonal}) {
    for (std::size_t i = 0; i < positions.size(); ++i)
      set_node_vector(u, static_cast<Index>(i), turn * positions[i] - positions[i]);
    DeformationReport report;
    largest = std::max(largest, std::abs(evaluate(u, f, report)));
  }
  return largest;
}

}}}  // namespace palpate::detail
