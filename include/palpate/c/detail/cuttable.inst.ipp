// Compiled once: linear compositions that can be cut, for the C interface.
#include <palpate/c/detail/composed_tissue.hpp>
#include <palpate/c/detail/policies.hpp>
#include <palpate/cut/cuttable.hpp>
#include <palpate/element/tet10.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/model/haptic_fe_model.tpp>

#include <array>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

template <class E>
std::unique_ptr<AnyTissue> make_cuttable(const TissueInput& input) {
  using Model = HapticFEModel<E, LinearElastic, Cuttable<Condensed<SelectiveInverse>>>;
  return std::make_unique<ComposedTissue<Model, CuttableTissue<E>>>(mesh_of<E>(input.mesh), input.scene,
                                                                    input.materials, input.options);
}

std::span<const Policy> cuttable_policies() noexcept {
  static constexpr std::array<Policy, 2> policies{{
      {"tet4/linear/cuttable_condensed", &make_cuttable<Tet4>},
      {"tet10/linear/cuttable_condensed", &make_cuttable<Tet10>},
  }};
  return policies;
}

}}}  // namespace palpate::PALPATE_ABI::c_interface
