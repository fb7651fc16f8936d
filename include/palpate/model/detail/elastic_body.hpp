// Interface of a linear elastic body for statics, independent of the element type.
#pragma once

#include <palpate/contact/detail/projected_half_space.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/contact/contact_surface.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/mesh_ref.hpp>
#include <palpate/mesh/scene.hpp>
#include <palpate/model/cache/detail/cache_key.hpp>
#include <palpate/model/detail/touchable.hpp>
#include <palpate/model/setup_report.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// An admitted body with its boundary. All functions are for set-up and for changes of loads, not for a tick. Vectors
/// have 3 entries per node. Functions that take a scene throw the errors of resolving it (unknown_group, empty_group,
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

  /// Throws unconstrained when the body can move rigidly. The error gives axes in the frame of the mesh as given.
  virtual void require_constrained(const EssentialConditions& conditions) const = 0;
  virtual EssentialConditions conditions(const Scene& scene) const = 0;
  virtual detail::Touchable touchable(const Scene& scene) const = 0;
  virtual std::vector<NodeId> rendered(const Scene& scene) const = 0;

  /// All loads of a scene except gravity [N].
  virtual VectorX applied_load(const Scene& scene) const = 0;
  /// Initial strain per region.
  virtual std::vector<Vector6> initial_strains(const Scene& scene) const = 0;
  virtual VectorX initial_strain_load(const std::vector<Vector6>& strains) const = 0;
  /// Swaps the initial strains, which `strain_energy` subtracts from the strain.
  virtual void swap_initial_strains(std::vector<Vector6>& strains) noexcept = 0;
  /// Mass per node [kg].
  virtual VectorX nodal_mass() const = 0;
  virtual double strain_energy(const VectorX& u) const = 0;

  /// The admitted mesh; valid as long as the body.
  virtual MeshRef mesh() const noexcept = 0;
  /// The elasticity matrices of the body [Pa], and the number of that of an element.
  virtual std::span<const Matrix6> elasticities() const noexcept = 0;
  virtual int elasticity_of(Index e) const noexcept = 0;

  /// The material of each of these elements at small strain; unknown if it is not isotropic.
  virtual std::vector<ContactMaterial> contact_materials(std::span<const Index> elements) const = 0;
  /// What its mesh makes of the compliance of a half-space, at these nodes. Allocates; on all threads.
  virtual detail::ProjectedHalfSpace half_space(std::span<const NodeId> touched, const EssentialConditions& conditions,
                                                const SetupLimits& limits) const = 0;
  virtual detail::CacheKey key() const noexcept = 0;
  virtual void report_locking(SetupReport& report) const = 0;
};

namespace detail {

/// An admitted body, translated so that the centre of its bounding box is the origin.
struct AdmittedBody {
  std::unique_ptr<ElasticBody> body;
  std::vector<NodeId> node_map;  ///< new id of every node as given, -1 for dropped nodes
  OriginalIds ids;               ///< ids of its nodes and elements in the mesh as given
  Vector3 origin;                ///< origin of its frame, in the frame of the mesh as given [m]
};

}  // namespace detail

}}  // namespace palpate
