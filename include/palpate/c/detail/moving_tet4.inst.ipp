// Compiled once: compositions of Smoothed<Tet4> at large strain, for the C interface.
#include <palpate/c/detail/moving_policies.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> moving_tet4_policies() noexcept {
  using Element = Smoothed<Tet4>;
  static constexpr std::array<Policy, 2> policies{{
      {"smoothed_tet4/neo_hookean/quasi_newton",
       &make_moving<Element, Tet4, Implicit<QuasiNewton<double>>, MovingTissue>},
      {"smoothed_tet4/neo_hookean/quasi_newton_float",
       &make_moving<Element, Tet4, Implicit<QuasiNewton<float>>, MovingTissue>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
