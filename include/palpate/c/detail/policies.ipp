// Definitions of policies.hpp, and the functions that list policies.
#pragma once

#include <palpate/c/detail/policies.hpp>
#include <palpate/c/detail/structs.hpp>

#include <array>
#include <string>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

namespace {

std::array<std::span<const Policy>, 10> all_policies() noexcept {
  return {smoothed_tet4_policies(), tet4_policies(),           tet10_policies(),    mean_dilatation_hex8_policies(),
          hex8_policies(),          hex20_policies(),          cuttable_policies(), moving_tet4_policies(),
          moving_tet10_policies(),  cuttable_moving_policies()};
}

}  // namespace

PALPATE_INLINE std::size_t policy_count() noexcept {
  std::size_t count = 0;
  for (const auto& some : all_policies()) count += some.size();
  return count;
}

PALPATE_INLINE const Policy* policy(std::size_t number) noexcept {
  for (const auto& some : all_policies()) {
    if (number < some.size()) return &some[number];
    number -= some.size();
  }
  return nullptr;
}

PALPATE_INLINE const Policy& find_policy(const char* name) {
  const std::string wanted = text(name, "the policy");
  const std::string element = wanted.substr(0, wanted.find('/') + 1);
  std::string same_element, all;
  for (std::size_t i = 0; i < policy_count(); ++i) {
    const Policy& known = *policy(i);
    if (wanted == known.name) return known;
    if (!element.empty() && std::string_view(known.name).starts_with(element))
      same_element.append(same_element.empty() ? "" : ", ").append(known.name);
    all.append(all.empty() ? "" : ", ").append(known.name);
  }
  // The hint has room for some: those of the element first.
  refuse("there is no policy '" + wanted + "'",
         "Available (palpate_policy_name): " + (same_element.empty() ? all : same_element));
}

}}}  // namespace palpate::PALPATE_ABI::c_interface

extern "C" {

size_t palpate_policy_count(void) {
  return palpate::c_interface::policy_count();
}

const char* palpate_policy_name(size_t number) {
  const palpate::c_interface::Policy* policy = palpate::c_interface::policy(number);
  return policy == nullptr ? nullptr : policy->name;
}

}  // extern "C"
