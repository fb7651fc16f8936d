// Compiled once: linear compositions of MeanDilatation<Hex8> for the C interface.
#include <palpate/element/hex8.hpp>
#include <palpate/element/wrappers.hpp>
#include <palpate/c/detail/linear_policies.hpp>
#include <palpate/model/shipped/shipped.hpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

std::span<const Policy> mean_dilatation_hex8_policies() noexcept {
  static constexpr std::array<Policy, 4> policies{{
      {"mean_dilatation_hex8/linear/condensed", make_condensed<MeanDilatation<Hex8>, Hex8>},
      {"mean_dilatation_hex8/linear/condensed_float", make_condensed_float<MeanDilatation<Hex8>, Hex8>},
      {"mean_dilatation_hex8/linear/inverse", make_inverse<MeanDilatation<Hex8>, Hex8>},
      {"mean_dilatation_hex8/linear/sparse_cholesky", make_sparse<MeanDilatation<Hex8>, Hex8>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
