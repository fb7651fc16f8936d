// A linear elastic body without its element type: what statics asks of it.
#pragma once

#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/load_vector.hpp>
#include <palpate/mesh/rigid_modes.hpp>
#include <palpate/model/admission_report.hpp>
#include <palpate/model/cache_key.hpp>
#include <palpate/model/touchable.hpp>

#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// An admitted body with its boundary. Everything here is for set-up and for changes of loads, none for a tick. Vectors
/// have 3 entries per node. Functions that take a scene throw what resolving it throws (unknown_group, empty_group,
/// unsupported ...).
class ElasticBody {
 public:
  ElasticBody() = default;
  ElasticBody(const ElasticBody&) = delete;
  ElasticBody& operator=(const ElasticBody&) = delete;
  virtual ~ElasticBody() = default;

  virtual const std::vector<Vector3>& positions() const noexcept = 0;
  virtual const std::vector<std::string>& region_names() const noexcept = 0;
  virtual const std::vector<double>& densities() const noexcept = 0;

  /// Refuses a body that can still move: unconstrained.
  virtual void require_constrained(const EssentialConditions& conditions) const = 0;
  virtual EssentialConditions conditions(const Scene& scene) const = 0;
  virtual Touchable touchable(const Scene& scene) const = 0;
  virtual std::vector<NodeId> seen(const Scene& scene) const = 0;

  /// All loads of a scene but gravity [N].
  virtual VectorX applied_load(const Scene& scene) const = 0;
  /// Initial strain per region.
  virtual std::vector<Vector6> initial_strains(const Scene& scene) const = 0;
  virtual VectorX initial_strain_load(const std::vector<Vector6>& strains) const = 0;
  /// What `strain_energy` leaves out.
  virtual void swap_initial_strains(std::vector<Vector6>& strains) noexcept = 0;
  /// Mass per node [kg].
  virtual VectorX nodal_mass() const = 0;
  virtual double strain_energy(const VectorX& u) const = 0;

  virtual CacheKey key() const noexcept = 0;
  virtual void report_locking(SetupReport& report) const = 0;
};

/// The body of elements E.
template <Element E>
class ElementBody final : public ElasticBody {
 public:
  static_assert(has_triangulated_faces<E>(),
                "palpate: tools touch triangles; give the element's Face a list `triangles` of its nodes, like Tri6");

  explicit ElementBody(Body<E> body);

  const Body<E>& body() const noexcept { return body_; }
  const std::vector<BoundaryFace<E>>& boundary() const noexcept { return boundary_; }

  const std::vector<Vector3>& positions() const noexcept override;
  const std::vector<std::string>& region_names() const noexcept override;
  const std::vector<double>& densities() const noexcept override;
  void require_constrained(const EssentialConditions& conditions) const override;
  EssentialConditions conditions(const Scene& scene) const override;
  Touchable touchable(const Scene& scene) const override;
  std::vector<NodeId> seen(const Scene& scene) const override;
  VectorX applied_load(const Scene& scene) const override;
  std::vector<Vector6> initial_strains(const Scene& scene) const override;
  VectorX initial_strain_load(const std::vector<Vector6>& strains) const override;
  void swap_initial_strains(std::vector<Vector6>& strains) noexcept override;
  VectorX nodal_mass() const override;
  double strain_energy(const VectorX& u) const override;
  CacheKey key() const noexcept override;
  void report_locking(SetupReport& report) const override;

 private:
  Body<E> body_;
  std::vector<BoundaryFace<E>> boundary_;
};

template <Element E>
ElementBody<E>::ElementBody(Body<E> body) : body_(std::move(body)), boundary_(extract_boundary<E>(body_.mesh)) {}

template <Element E>
const std::vector<Vector3>& ElementBody<E>::positions() const noexcept {
  return body_.mesh.positions;
}
template <Element E>
const std::vector<std::string>& ElementBody<E>::region_names() const noexcept {
  return body_.mesh.region_names;
}
template <Element E>
const std::vector<double>& ElementBody<E>::densities() const noexcept {
  return body_.density;
}
template <Element E>
void ElementBody<E>::require_constrained(const EssentialConditions& conditions) const {
  palpate::require_constrained(body_.mesh, conditions.constrained);
}
template <Element E>
EssentialConditions ElementBody<E>::conditions(const Scene& scene) const {
  return resolve_essential(body_.mesh, boundary_, scene);
}
template <Element E>
Touchable ElementBody<E>::touchable(const Scene& scene) const {
  return resolve_touchable(body_.mesh, boundary_, scene);
}
template <Element E>
std::vector<NodeId> ElementBody<E>::seen(const Scene& scene) const {
  return resolve_seen(body_.mesh, boundary_, scene);
}
template <Element E>
VectorX ElementBody<E>::applied_load(const Scene& scene) const {
  return palpate::applied_load(body_, boundary_, scene);
}
template <Element E>
std::vector<Vector6> ElementBody<E>::initial_strains(const Scene& scene) const {
  return initial_strains_by_region(body_.mesh, scene);
}
template <Element E>
VectorX ElementBody<E>::initial_strain_load(const std::vector<Vector6>& strains) const {
  return palpate::initial_strain_load(body_, strains);
}
template <Element E>
void ElementBody<E>::swap_initial_strains(std::vector<Vector6>& strains) noexcept {
  body_.initial_strain.swap(strains);
}
template <Element E>
VectorX ElementBody<E>::nodal_mass() const {
  return palpate::nodal_mass(body_);
}
template <Element E>
double ElementBody<E>::strain_energy(const VectorX& u) const {
  return palpate::strain_energy(body_, u);
}
template <Element E>
CacheKey ElementBody<E>::key() const noexcept {
  return body_key(body_);
}
template <Element E>
void ElementBody<E>::report_locking(SetupReport& report) const {
  palpate::report_locking<E>(body_.elasticity, report);
}

}}  // namespace palpate
