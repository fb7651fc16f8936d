// Compiled once: linear compositions of Tet10 for the C interface.
#include <palpate/element/tet10.hpp>
#include <palpate/c/detail/linear_policies.hpp>
#include <palpate/model/shipped/shipped.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> tet10_policies() noexcept {
  static constexpr std::array<Policy, 4> policies{{
      {"tet10/linear/condensed", make_condensed<Tet10>},
      {"tet10/linear/condensed_float", make_condensed_float<Tet10>},
      {"tet10/linear/inverse", make_inverse<Tet10>},
      {"tet10/linear/sparse_cholesky", make_sparse<Tet10>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
