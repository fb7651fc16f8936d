// Compiled once: the composition at large strain that can be cut, for the C interface.
#include <palpate/c/detail/moving_policies.hpp>
#include <palpate/cut/cuttable_moving.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/element/wrappers.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> cuttable_moving_policies() noexcept {
  using Element = Smoothed<Tet4>;
  static constexpr std::array<Policy, 1> policies{{
      {"smoothed_tet4/neo_hookean/cuttable_quasi_newton",
       &make_moving<Element, Tet4, Cuttable<Implicit<QuasiNewton<double>>>, CuttableMovingTissue<Element>>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
