// Linear viscoelasticity at small strain.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/elastic_forces.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/integrator.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/material/viscoelastic.hpp>
#include <palpate/mesh/mesh.hpp>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// A body at small strain with the Prony series of its regions.
template <Element E>
struct ViscousBody {
  Body<E> fast;                               ///< the instantaneous body, right after a sudden strain
  std::vector<std::vector<PronyTerm>> terms;  ///< by region
  std::vector<Relaxation> relaxation;         ///< by region
};

namespace detail {

/// Elasticity of every material of a body [Pa], where region r counts `share(r)` of the relaxing part and `kept` of
/// the constant part. Throws unsupported for deviatoric relaxation where the pressure depends on the deviatoric strain
/// (anisotropic material): the constant part is then not an elasticity.
template <Element E, class Share>
std::vector<Matrix6> shares_of_elasticity(const ViscousBody<E>& body, double kept, Share share) {
  const Body<E>& fast = body.fast;
  std::vector<std::size_t> region(fast.elasticity.size());
  for (Index e = 0; e < fast.mesh.element_count(); ++e) region[fast.material_of(e)] = fast.region_of(e);
  std::vector<Matrix6> shares;
  for (std::size_t material = 0; material < region.size(); ++material) {
    const Matrix6& d = fast.elasticity[material];
    Matrix6 lasting = Matrix6::Zero();
    if (body.relaxation[region[material]] == Relaxation::deviatoric) {
      Vector6 pressure;  // per strain
      for (int i = 0; i < 6; ++i) pressure[i] = (d(0, i) + d(1, i) + d(2, i)) / 3.0;
      const double bulk = (pressure[0] + pressure[1] + pressure[2]) / 3.0;
      for (int i = 0; i < 3; ++i) {
        pressure[i] -= bulk;
        for (int j = 0; j < 3; ++j) lasting(i, j) = bulk;
      }
      if (!(pressure.norm() <= 1e-9 * bulk))
        raise(SetupErrorKind::unsupported, "deviatoric relaxation of an anisotropic material",
              "Choose Relaxation::whole_stress");
    }
    shares.push_back(share(region[material]) * (d - lasting) + kept * lasting);
  }
  return shares;
}

/// All relaxation times, each once.
inline std::vector<double> distinct_times(const std::vector<std::vector<PronyTerm>>& by_region) {
  std::vector<double> times;
  for (const auto& terms : by_region)
    for (const PronyTerm& t : terms) times.push_back(t.relaxation_time);
  std::ranges::sort(times);
  times.erase(std::unique(times.begin(), times.end()), times.end());
  return times;
}

}  // namespace detail

/// An admitted mesh with viscoelastic materials by region name; throws as materials_by_region.
template <Element E, LinearMaterial Base, int Terms>
ViscousBody<E> make_body(Mesh<E> mesh, const RegionMaterials<Viscoelastic<Base, Terms>>& materials) {
  ViscousBody<E> body;
  std::vector<Base> bases;
  for (const auto& material : detail::materials_by_region(mesh, materials)) {
    bases.push_back(material.base);
    bases.back().density = material.density;
    body.terms.emplace_back(material.terms.begin(), material.terms.end());
    body.relaxation.push_back(material.relaxation);
  }
  body.fast = make_body(std::move(mesh), bases);
  return body;
}
/// The same with one material for all regions.
template <Element E, LinearMaterial Base, int Terms>
ViscousBody<E> make_body(Mesh<E> mesh, const Viscoelastic<Base, Terms>& material) {
  return make_body(std::move(mesh), RegionMaterials<Viscoelastic<Base, Terms>>{{everywhere, material}});
}

namespace detail {

/// f = K_0 u + sum_i K_i w_i, where K_i is the stiffness of the part that relaxes with tau_i and w_i' + w_i / tau_i =
/// u'. Stress is linear in strain and strain in u, so one displacement vector per relaxation time stores the history of
/// all points of all elements. Over a step f = K u + past, where K is constant while dt is constant: a step costs as
/// much as an elastic one plus one product per relaxation time. One BlockMatrix per relaxation time.
class ViscousForces final : public ElasticForces {
 public:
  static constexpr bool has_history = true;

  /// Throws as assemble_stiffness, and unsupported for deviatoric relaxation of an anisotropic material.
  template <Element E>
  explicit ViscousForces(ViscousBody<E> body, const SetupLimits& limits = {}) : times_(distinct_times(body.terms)) {
    const auto assemble = [&](const ViscousBody<E>& of, double kept, auto share) {
      Body<E> part = of.fast;
      part.elasticity = shares_of_elasticity(of, kept, share);
      return assemble_stiffness<E>(part, limits);
    };
    const auto share_of = [&](std::size_t region, double time) {
      double share = 0.0;
      for (const PronyTerm& t : body.terms[region]) share += t.relaxation_time == time ? t.share : 0.0;
      return share;
    };
    slow_ = assemble(body, 1.0, [&](std::size_t r) {
      double left = 1.0;
      for (const PronyTerm& t : body.terms[r]) left -= t.share;
      return left;
    });
    for (const double time : times_)
      fading_.push_back(assemble(body, 0.0, [&](std::size_t r) { return share_of(r, time); }));
    step_ = slow_;
    last_ = past_ = trial_ = product_ = VectorX::Zero(slow_.size());
    history_.assign(times_.size(), last_);
    decay_.resize(times_.size());
    gain_.resize(times_.size());
    ViscousForces::begin_step(0.0);
  }

  Index size() const noexcept override { return step_.size(); }
  double energy(const VectorX& u) const noexcept override;
  DeformationReport force(const VectorX& u, VectorX& f) const noexcept override;
  void tangent(const VectorX&, BlockMatrix& k) const noexcept override { k.copy_values(step_); }
  bool is_linear() const noexcept override { return true; }

  void begin_step(double dt) noexcept override;
  void end_step(const VectorX& u) noexcept override;

 private:
  void set_length(double dt) noexcept;

  std::vector<double> times_, decay_, gain_;
  BlockMatrix slow_, step_;
  std::vector<BlockMatrix> fading_;
  std::vector<VectorX> history_;
  VectorX last_, past_, trial_;
  mutable VectorX product_;
  double dt_ = -1.0;
};

inline double ViscousForces::energy(const VectorX& u) const noexcept {
  step_.apply(u, product_);
  return u.dot(0.5 * product_ + past_);
}

inline DeformationReport ViscousForces::force(const VectorX& u, VectorX& f) const noexcept {
  step_.apply(u, f);
  f += past_;
  DeformationReport report;
  report.smallest_volume_ratio = 1.0;
  return report;
}

inline void ViscousForces::begin_step(double dt) noexcept {
  if (dt != dt_) set_length(dt);
  past_.setZero();
  for (std::size_t i = 0; i < times_.size(); ++i) {
    trial_ = decay_[i] * history_[i] - gain_[i] * last_;
    fading_[i].apply(trial_, product_);
    past_ += product_;
  }
}

inline void ViscousForces::end_step(const VectorX& u) noexcept {
  for (std::size_t i = 0; i < times_.size(); ++i) history_[i] = decay_[i] * history_[i] + gain_[i] * (u - last_);
  last_ = u;
}

inline void ViscousForces::set_length(double dt) noexcept {
  dt_ = dt;
  step_.copy_values(slow_);
  for (std::size_t i = 0; i < times_.size(); ++i) {
    decay_[i] = std::exp(-dt / times_[i]);
    gain_[i] = mean_decay(dt / times_[i]);
    step_.add(gain_[i], fading_[i]);
  }
}

}  // namespace detail

}}  // namespace palpate
