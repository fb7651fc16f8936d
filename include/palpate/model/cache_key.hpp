// What a prepared system depends on.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/core/content_hash.hpp>
#include <palpate/model/cache_report.hpp>

namespace palpate { inline namespace PALPATE_ABI {

/// Everything that decides the numbers in a cache file, part by part, so that a mismatch has a name. The stiffness
/// matrix is hashed as well, value by value: whatever the parts may miss (an element or law whose code was changed,
/// other compiler flags) shows there. Plain bytes, stored as they are.
struct CacheKey {
  std::array<char, 64> policy{};   ///< name, filled up with zeros
  std::uint64_t scalar_bytes = 0;  ///< of the stored compliance: 4 or 8
  std::uint64_t element = 0;       ///< reference nodes, shape functions and gradients at the quadrature points
  std::uint64_t mesh = 0;          ///< positions, connectivity, regions
  std::uint64_t material = 0;      ///< elasticity matrix of every region or element
  std::uint64_t conditions = 0;    ///< which components of which nodes are prescribed
  std::uint64_t touched = 0;       ///< kept nodes
  std::uint64_t stiffness = 0;     ///< pattern and values

  void set_policy(std::string_view name) noexcept {
    policy.fill('\0');
    std::copy_n(name.data(), std::min(name.size(), policy.size() - 1), policy.data());
  }
  std::string_view policy_name() const noexcept {
    return {policy.data(), static_cast<std::size_t>(std::ranges::find(policy, '\0') - policy.begin())};
  }
};

namespace detail {

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) noexcept {
  ContentHash hash;
  hash.add(std::span<const T>(values));
  return hash.digest();
}

template <class Matrix>
void add_entries(ContentHash& hash, const Matrix& m) noexcept {
  hash.add(std::span<const double>(m.data(), static_cast<std::size_t>(m.size())));
}

template <Element E>
std::uint64_t hash_of_element() noexcept {
  ContentHash hash;
  hash.add(E::nodes);
  add_entries(hash, E::reference_nodes().eval());
  for (const auto& point : E::Quadrature::points) {
    const Vector3 xi(point.xi[0], point.xi[1], point.xi[2]);
    add_entries(hash, E::shape(xi).eval());
    add_entries(hash, E::gradient(xi).eval());
    hash.add(point.weight);
  }
  return hash.digest();
}

template <Element E>
std::uint64_t hash_of_mesh(const Mesh<E>& mesh) noexcept {
  ContentHash hash;
  static_assert(sizeof(Vector3) == 3 * sizeof(double));
  const double* first = mesh.positions.empty() ? nullptr : mesh.positions.front().data();
  hash.add(std::span<const double>(first, 3 * mesh.positions.size()));
  hash.add(std::span<const typename Mesh<E>::Connectivity>(mesh.elements));
  hash.add(std::span<const int>(mesh.regions));
  return hash.digest();
}

inline std::uint64_t hash_of_stiffness(const BlockMatrix& k) noexcept {
  ContentHash hash;
  hash.add(std::span<const Index>(k.pattern().row_start));
  hash.add(std::span<const NodeId>(k.pattern().column));
  hash.add(std::span<const double>(k.block(0).data(), 9 * k.pattern().column.size()));
  return hash.digest();
}

}  // namespace detail

/// The key of a body held at `conditions` and touched at `kept`, for a solver. Cost: one pass over mesh and stiffness.
template <Element E>
CacheKey cache_key(const Body<E>& body, const EssentialConditions& conditions, const std::vector<NodeId>& kept,
                   const BlockMatrix& stiffness, std::string_view policy, std::size_t scalar_bytes) noexcept {
  CacheKey key;
  key.set_policy(policy);
  key.scalar_bytes = scalar_bytes;
  key.element = detail::hash_of_element<E>();
  key.mesh = detail::hash_of_mesh(body.mesh);
  ContentHash material;
  for (const Matrix6& d : body.elasticity) detail::add_entries(material, d);
  material.add(std::span<const std::int32_t>(body.laws));
  key.material = material.digest();
  key.conditions = detail::hash_of(conditions.constrained);
  key.touched = detail::hash_of(kept);
  key.stiffness = detail::hash_of_stiffness(stiffness);
  return key;
}

/// Compares the key in a file with the one at hand: the first part that differs, and in `why` all of them.
inline CacheMismatch compare(const CacheKey& file, const CacheKey& here, std::string& why) {
  CacheMismatch first = CacheMismatch::none;
  const auto differs = [&](bool difference, CacheMismatch part, const std::string& sentence) {
    if (!difference) return;
    if (first == CacheMismatch::none) first = part;
    why += (why.empty() ? "" : ", ") + sentence;
  };
  const auto scalar = [](const CacheKey& k) -> std::string { return k.scalar_bytes == 4 ? "float" : "double"; };
  differs(file.scalar_bytes != here.scalar_bytes, CacheMismatch::scalar,
          "the scalar differs (" + scalar(file) + " in the file, " + scalar(here) + " here)");
  differs(file.policy != here.policy, CacheMismatch::policy,
          "the policy differs (" + std::string(file.policy_name()) + " in the file, " +
              std::string(here.policy_name()) + " here)");
  differs(file.element != here.element, CacheMismatch::element, "the element differs");
  differs(file.mesh != here.mesh, CacheMismatch::mesh, "the mesh differs");
  differs(file.material != here.material, CacheMismatch::material, "the material differs");
  differs(file.conditions != here.conditions, CacheMismatch::conditions, "the conditions differ");
  differs(file.touched != here.touched, CacheMismatch::touched, "the touched set differs");
  if (first == CacheMismatch::none)
    differs(file.stiffness != here.stiffness, CacheMismatch::stiffness,
            "the stiffness differs, though nothing that makes it does: other code or compiler flags");
  return first;
}

}}  // namespace palpate
