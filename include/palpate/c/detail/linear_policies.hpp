// Linear static compositions of one element. All are in palpate::compiled.
#pragma once

#include <palpate/c/detail/composed_tissue.hpp>
#include <palpate/c/detail/policies.hpp>
#include <palpate/model/haptic_fe_model.hpp>
#include <palpate/model/policies.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI { namespace c_interface {

/// A tissue on a mesh of `Given`, an element with the same nodes.
template <class E, class Given, class Solver>
std::unique_ptr<AnyTissue> make_linear(const TissueInput& input) {
  using Model = HapticFEModel<E, LinearElastic, Solver>;
  using Touched = LinearTissue<typename SolverTraits<Solver>::Scalar>;
  return std::make_unique<ComposedTissue<Model, Touched>>(mesh_of<Given>(input.mesh), input.scene, input.materials,
                                                          input.options);
}

template <class E, class Given = E>
inline constexpr auto make_condensed = &make_linear<E, Given, Condensed<SelectiveInverse>>;
template <class E, class Given = E>
inline constexpr auto make_condensed_float = &make_linear<E, Given, Condensed<SelectiveInverseFloat>>;
template <class E, class Given = E>
inline constexpr auto make_inverse = &make_linear<E, Given, SelectiveInverse>;
template <class E, class Given = E>
inline constexpr auto make_sparse = &make_linear<E, Given, SparseCholesky>;

}}}  // namespace palpate::PALPATE_ABI::c_interface
