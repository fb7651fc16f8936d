// The inputs that a prepared system depends on.
#pragma once

#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/concepts/quadrature.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/content_hash.hpp>
#include <palpate/core/types.hpp>
#include <palpate/mesh/mesh.hpp>
#include <palpate/model/cache/cache_report.hpp>

#include <array>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Hashes of all inputs that determine the numbers in a cache file, one per part, so that a mismatch can be named. All
/// values of the stiffness matrix are hashed too, which detects differences that the parts miss (changed code of an
/// element or material, other compiler flags). Plain bytes, stored unchanged.
struct CacheKey {
  std::array<char, 64> policy{};   ///< name, padded with zeros
  std::uint64_t scalar_bytes = 0;  ///< of the stored compliance: 4 or 8
  std::uint64_t element = 0;       ///< reference nodes, shape functions and gradients at the quadrature points
  std::uint64_t mesh = 0;          ///< positions, connectivity, regions
  std::uint64_t material = 0;      ///< elasticity matrix of every region or element
  std::uint64_t conditions = 0;    ///< which components of which nodes are prescribed
  std::uint64_t touched = 0;       ///< kept nodes
  std::uint64_t stiffness = 0;     ///< pattern and values

  void set_policy(std::string_view name) noexcept;
  std::string_view policy_name() const noexcept;
};

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

/// The part of a key that depends on the body only. Cost: one pass over the mesh.
template <Element E>
CacheKey body_key(const Body<E>& body) noexcept {
  CacheKey key;
  key.element = hash_of_element<E>();
  key.mesh = hash_of_mesh(body.mesh);
  ContentHash material;
  for (const Matrix6& d : body.elasticity) add_entries(material, d);
  material.add(std::span<const std::int32_t>(body.materials));
  key.material = material.digest();
  return key;
}

/// The key of a body with constraints `conditions` and touchable nodes `kept`, for a solver. Cost: one pass over the
/// stiffness.
CacheKey cache_key(CacheKey of_body, const EssentialConditions& conditions, const std::vector<NodeId>& kept,
                   const BlockMatrix& stiffness, std::string_view policy, std::size_t scalar_bytes) noexcept;

/// Compares the key in a file with the current one. Returns the first part that differs; `why` lists all of them.
CacheMismatch compare(const CacheKey& file, const CacheKey& here, std::string& why);

}}}  // namespace palpate::detail

#if PALPATE_HEADER_ONLY
#include <palpate/model/cache/detail/cache_key.ipp>
#endif
