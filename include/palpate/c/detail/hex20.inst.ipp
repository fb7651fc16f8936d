// Compiled once: linear compositions of Hex20 for the C interface.
#include <palpate/element/hex20.hpp>
#include <palpate/c/detail/linear_policies.hpp>
#include <palpate/model/shipped/shipped.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> hex20_policies() noexcept {
  static constexpr std::array<Policy, 4> policies{{
      {"hex20/linear/condensed", make_condensed<Hex20>},
      {"hex20/linear/condensed_float", make_condensed_float<Hex20>},
      {"hex20/linear/inverse", make_inverse<Hex20>},
      {"hex20/linear/sparse_cholesky", make_sparse<Hex20>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
