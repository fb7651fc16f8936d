// The compositions of the C interface, by name.
#pragma once

#include <palpate/c/detail/any_tissue.hpp>
#include <palpate/c/detail/given_mesh.hpp>
#include <palpate/concepts/material.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/material/linear_elastic.hpp>
#include <palpate/mesh/scene.hpp>

#include <memory>
#include <span>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// Options of tissue that moves; zeros are the defaults.
struct MotionInput {
  double step = 0.0;          ///< [s]
  double mass_damping = 0.0;  ///< [1/s]
  bool quasi_static = false;
};

/// What a tissue is made from. The materials are those of any law with these three parameters.
struct TissueInput {
  const GivenMesh& mesh;
  const Scene& scene;
  RegionMaterials<LinearElastic> materials;
  SetupOptions options;
  MotionInput motion;
};

struct Policy {
  const char* name;
  std::unique_ptr<AnyTissue> (*make)(const TissueInput&);
};

// One source each.
std::span<const Policy> tet4_policies() noexcept;
std::span<const Policy> smoothed_tet4_policies() noexcept;
std::span<const Policy> tet10_policies() noexcept;
std::span<const Policy> hex8_policies() noexcept;
std::span<const Policy> mean_dilatation_hex8_policies() noexcept;
std::span<const Policy> hex20_policies() noexcept;
std::span<const Policy> cuttable_policies() noexcept;
std::span<const Policy> cuttable_moving_policies() noexcept;
std::span<const Policy> moving_tet4_policies() noexcept;
std::span<const Policy> moving_tet10_policies() noexcept;

/// Number of all policies.
std::size_t policy_count() noexcept;
/// Null for a number that does not exist.
const Policy* policy(std::size_t number) noexcept;
/// Refuses an unknown name; the hint lists all.
const Policy& find_policy(const char* name);

}}}  // namespace palpate::PALPATE_ABI::c_interface
