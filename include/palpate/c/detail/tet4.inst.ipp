// Compiled once: linear compositions of Tet4 for the C interface.
#include <palpate/element/tet4.hpp>
#include <palpate/c/detail/linear_policies.hpp>
#include <palpate/model/shipped/shipped.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> tet4_policies() noexcept {
  static constexpr std::array<Policy, 4> policies{{
      {"tet4/linear/condensed", make_condensed<Tet4>},
      {"tet4/linear/condensed_float", make_condensed_float<Tet4>},
      {"tet4/linear/inverse", make_inverse<Tet4>},
      {"tet4/linear/sparse_cholesky", make_sparse<Tet4>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
