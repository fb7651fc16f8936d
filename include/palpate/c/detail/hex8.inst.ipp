// Compiled once: linear compositions of Hex8 for the C interface.
#include <palpate/element/hex8.hpp>
#include <palpate/c/detail/linear_policies.hpp>
#include <palpate/model/shipped/shipped.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> hex8_policies() noexcept {
  static constexpr std::array<Policy, 4> policies{{
      {"hex8/linear/condensed", make_condensed<Hex8>},
      {"hex8/linear/condensed_float", make_condensed_float<Hex8>},
      {"hex8/linear/inverse", make_inverse<Hex8>},
      {"hex8/linear/sparse_cholesky", make_sparse<Hex8>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
