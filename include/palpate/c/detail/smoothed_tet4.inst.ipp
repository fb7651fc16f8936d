// Compiled once: linear compositions of Smoothed<Tet4> for the C interface.
#include <palpate/element/wrappers.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/c/detail/linear_policies.hpp>
#include <palpate/model/shipped/shipped.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> smoothed_tet4_policies() noexcept {
  static constexpr std::array<Policy, 4> policies{{
      {"smoothed_tet4/linear/condensed", make_condensed<Smoothed<Tet4>, Tet4>},
      {"smoothed_tet4/linear/condensed_float", make_condensed_float<Smoothed<Tet4>, Tet4>},
      {"smoothed_tet4/linear/inverse", make_inverse<Smoothed<Tet4>, Tet4>},
      {"smoothed_tet4/linear/sparse_cholesky", make_sparse<Smoothed<Tet4>, Tet4>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
