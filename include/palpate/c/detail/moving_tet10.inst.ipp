// Compiled once: compositions of Tet10 and Hex20 at large strain, for the C interface.
#include <palpate/c/detail/moving_policies.hpp>
#include <palpate/element/hex20.hpp>
#include <palpate/element/tet10.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> moving_tet10_policies() noexcept {
  static constexpr std::array<Policy, 2> policies{{
      {"tet10/neo_hookean/quasi_newton", &make_moving<Tet10, Tet10, Implicit<QuasiNewton<double>>, MovingTissue>},
      {"hex20/neo_hookean/quasi_newton", &make_moving<Hex20, Hex20, Implicit<QuasiNewton<double>>, MovingTissue>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
