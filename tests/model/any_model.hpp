#pragma once

#include <palpate/concepts/tissue_adaptor.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/model/haptic_fe_model.hpp>

/// A model of any solver policy behind one interface, so that each policy is compiled once per test executable.
namespace test {

using namespace palpate;

enum class PolicyName {
  sparse_cholesky,
  conjugate_gradient,
  matrix_free_conjugate_gradient,
  selective_inverse,
  condensed_inverse,
  condensed_float,
  condensed_cholesky,
  condensed_conjugate_gradient,
};

inline constexpr std::array all_policies{
    PolicyName::sparse_cholesky,    PolicyName::conjugate_gradient,          PolicyName::matrix_free_conjugate_gradient,
    PolicyName::selective_inverse,  PolicyName::condensed_inverse,           PolicyName::condensed_float,
    PolicyName::condensed_cholesky, PolicyName::condensed_conjugate_gradient};

inline const char* name(PolicyName p) {
  constexpr std::array names{
      "SparseCholesky",           "ConjugateGradient",           "WithAssembly<ConjugateGradient, MatrixFree>",
      "SelectiveInverse",         "Condensed<SelectiveInverse>", "Condensed<SelectiveInverseFloat>",
      "Condensed<DenseCholesky>", "Condensed<ConjugateGradient>"};
  return names[static_cast<std::size_t>(p)];
}

/// Relative accuracy to expect on a well conditioned body.
inline double accuracy(PolicyName p) {
  if (p == PolicyName::condensed_float) return 1e-4;
  const bool iterative = p == PolicyName::conjugate_gradient || p == PolicyName::matrix_free_conjugate_gradient ||
                         p == PolicyName::condensed_conjugate_gradient;
  return iterative ? 1e-8 : 1e-11;
}

/// See HapticFEModel. Satisfies TissueModel.
class AnyModel : public StillTissue {
 public:
  AnyModel() = default;
  AnyModel(const AnyModel&) = delete;
  AnyModel& operator=(const AnyModel&) = delete;
  virtual ~AnyModel() = default;
  virtual const SetupReport& report() const = 0;
  virtual const Mesh<Tet4>& mesh() const = 0;
  virtual const std::vector<NodeId>& node_map() const = 0;
  virtual const std::vector<NodeId>& touchable_nodes() const = 0;
  virtual const std::vector<NodeId>& rendered_nodes() const = 0;
  virtual Vector3 rest_position(NodeId) const = 0;
  virtual const VectorX& displacement() const = 0;
  virtual VectorX internal_force() const = 0;
  virtual VectorX reactions() const = 0;
  virtual double strain_energy() const = 0;
  virtual SolveReport displacement_with(std::span<const VertexForce>, VectorX&) = 0;
  virtual void set_conditions(const Scene&) = 0;
  virtual void set_gravity(const Vector3&) = 0;
  virtual void set_pose(const Eigen::Isometry3d&) = 0;
  virtual const Eigen::Isometry3d& pose() const noexcept = 0;
  virtual void reset() = 0;
  virtual const ContactSurface& contact_surface() const noexcept = 0;
  virtual Status require_columns(std::span<const int>) noexcept = 0;
  virtual void prefetch(std::span<const int>) noexcept = 0;
  virtual Matrix3 half_space_map(int) const noexcept = 0;
  virtual Matrix3 compliance(int, int) const noexcept = 0;
  virtual double compliance_bound(int) const noexcept = 0;
  virtual std::uint64_t compliance_revision() const noexcept = 0;
  virtual double compliance_floor() const noexcept = 0;
  virtual const Eigen::Isometry3d& to_world() const noexcept = 0;
};

using Materials = RegionMaterials<LinearElastic>;

/// Defined by one source per test executable, with model/make_any_model.hpp. Policies that are not compiled in fail the
/// test.
std::unique_ptr<AnyModel> make_model(PolicyName policy, const Mesh<Tet4>& mesh, const Scene& scene,
                                     const Materials& materials, const SetupOptions& options = {});

inline std::unique_ptr<AnyModel> make_model(PolicyName policy, const Mesh<Tet4>& mesh, const Scene& scene,
                                            const LinearElastic& material, const SetupOptions& options = {}) {
  return make_model(policy, mesh, scene, Materials{{everywhere, material}}, options);
}

}  // namespace test
