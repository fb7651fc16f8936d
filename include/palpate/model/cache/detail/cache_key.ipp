// Definitions of cache_key.hpp.
#pragma once

#include <palpate/model/cache/detail/cache_key.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void CacheKey::set_policy(std::string_view name) noexcept {
  policy.fill('\0');
  std::copy_n(name.data(), std::min(name.size(), policy.size() - 1), policy.data());
}

PALPATE_INLINE std::string_view CacheKey::policy_name() const noexcept {
  return {policy.data(), static_cast<std::size_t>(std::ranges::find(policy, '\0') - policy.begin())};
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

template <class T>
std::uint64_t hash_of(const std::vector<T>& values) noexcept {
  ContentHash hash;
  hash.add(std::span<const T>(values));
  return hash.digest();
}

inline std::uint64_t hash_of_stiffness(const BlockMatrix& k) noexcept {
  ContentHash hash;
  hash.add(std::span<const Index>(k.pattern().row_start));
  hash.add(std::span<const NodeId>(k.pattern().column));
  hash.add(std::span<const double>(k.block(0).data(), 9 * k.pattern().column.size()));
  return hash.digest();
}

}}}  // namespace palpate::detail

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE CacheKey cache_key(CacheKey of_body, const EssentialConditions& conditions,
                                  const std::vector<NodeId>& kept, const BlockMatrix& stiffness,
                                  std::string_view policy, std::size_t scalar_bytes) noexcept {
  CacheKey key = of_body;
  key.set_policy(policy);
  key.scalar_bytes = scalar_bytes;
  key.conditions = hash_of(conditions.constrained);
  key.touched = hash_of(kept);
  key.stiffness = hash_of_stiffness(stiffness);
  return key;
}

PALPATE_INLINE CacheMismatch compare(const CacheKey& file, const CacheKey& here, std::string& why) {
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
            "the stiffness differs, but none of its inputs does: other code or compiler flags");
  return first;
}

}}}  // namespace palpate::detail
