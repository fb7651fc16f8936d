// Definitions of vertex_materials.hpp.
#pragma once

#include <palpate/local/detail/split_elasticity.hpp>
#include <palpate/model/detail/vertex_materials.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// Largest difference of a material from the isotropic one with the same moduli, relative to its largest entry.
inline double anisotropy(const Matrix6& d) noexcept {
  const double mu = equivalent_shear_modulus(d), lambda = bulk_modulus(d) - 2.0 / 3.0 * mu;
  double difference = 0.0;
  for (int j = 0; j < 6; ++j)
    for (int i = 0; i < 6; ++i) {
      const double same = (i < 3 && j < 3 ? lambda : 0.0) + (i != j ? 0.0 : i < 3 ? 2.0 * mu : mu);
      difference = std::max(difference, std::abs(d(i, j) - same));
    }
  return difference / d.cwiseAbs().maxCoeff();
}

/// The isotropic material that stands for an elasticity matrix.
struct EquivalentMaterial {
  double shear_modulus = 0.0, poisson_ratio = 0.0;
  int ratio = 0;  // number of the Poisson ratio, of matrices that are used
  bool anisotropic = false;

  bool is_like(const EquivalentMaterial& other) const noexcept {
    return std::abs(shear_modulus - other.shear_modulus) <= same * shear_modulus &&
           std::abs(poisson_ratio - other.poisson_ratio) <= same;
  }
  static constexpr double same = 1e-6;
};

/// The equivalent material of every elasticity matrix. Adds each Poisson ratio of the matrices in use to `ratios` once.
inline std::vector<EquivalentMaterial> equivalent_materials(std::span<const Matrix6> elasticities,
                                                            const std::vector<bool>& used,
                                                            std::vector<double>& ratios) {
  constexpr double largest_ratio = 0.49999, anisotropic = 0.05;
  std::vector<EquivalentMaterial> materials;
  for (std::size_t m = 0; m < elasticities.size(); ++m) {
    const Matrix6& d = elasticities[m];
    const double nu = std::min(equivalent_poisson_ratio(d), largest_ratio);
    materials.push_back({equivalent_shear_modulus(d), nu, 0, anisotropy(d) > anisotropic});
    if (!used[m]) continue;
    auto known = std::ranges::find_if(ratios, [&](double r) { return std::abs(r - nu) <= EquivalentMaterial::same; });
    if (known == ratios.end()) known = ratios.insert(known, nu);
    materials.back().ratio = static_cast<int>(known - ratios.begin());
  }
  return materials;
}

/// The mean of the materials of elements.
inline VertexMaterial mean_material(std::span<const NodeId> elements, std::span<const int> material_of,
                                    std::span<const EquivalentMaterial> materials, std::vector<int>& votes) {
  VertexMaterial mean;
  std::ranges::fill(votes, 0);
  for (const NodeId e : elements) {
    const EquivalentMaterial& material = materials[static_cast<std::size_t>(material_of[static_cast<std::size_t>(e)])];
    mean.shear_modulus += material.shear_modulus;
    ++votes[static_cast<std::size_t>(material.ratio)];
    if (material.anisotropic) mean.marks.set(HalfSpaceMark::anisotropic);
  }
  mean.shear_modulus /= static_cast<double>(elements.size());
  mean.stiffness = static_cast<int>(std::ranges::max_element(votes) - votes.begin());
  return mean;
}

/// Whether all elements within two of a node are of one material.
inline bool is_uniform_near(NodeId node, const MeshRef& mesh, const NodeElements& around,
                            std::span<const int> material_of, std::span<const EquivalentMaterial> materials) {
  const auto material = [&](NodeId e) -> const EquivalentMaterial& {
    return materials[static_cast<std::size_t>(material_of[static_cast<std::size_t>(e)])];
  };
  const EquivalentMaterial& first = material(around.of(node)[0]);
  for (const NodeId e : around.of(node))
    for (int a = 0; a < mesh.element.nodes; ++a)
      for (const NodeId other : around.of(mesh.nodes_of(e)[a]))
        if (!first.is_like(material(other))) return false;
  return true;
}

}  // namespace detail

PALPATE_INLINE std::vector<VertexMaterial> vertex_materials(const MeshRef& mesh, std::span<const NodeId> touched,
                                                            const NodeElements& around,
                                                            std::span<const Matrix6> elasticities,
                                                            std::span<const int> material_of,
                                                            std::vector<double>& ratios) {
  std::vector<bool> used(elasticities.size(), false);
  for (const NodeId node : touched)
    for (const NodeId e : around.of(node))
      used[static_cast<std::size_t>(material_of[static_cast<std::size_t>(e)])] = true;
  const auto materials = detail::equivalent_materials(elasticities, used, ratios);
  std::vector<int> votes(ratios.size());
  std::vector<VertexMaterial> result;
  for (const NodeId node : touched) {
    VertexMaterial& mean = result.emplace_back(detail::mean_material(around.of(node), material_of, materials, votes));
    mean.poisson_ratio = ratios[static_cast<std::size_t>(mean.stiffness)];
    if (elasticities.size() > 1 && !detail::is_uniform_near(node, mesh, around, material_of, materials))
      mean.marks.set(HalfSpaceMark::several_materials);
  }
  return result;
}

}}  // namespace palpate
