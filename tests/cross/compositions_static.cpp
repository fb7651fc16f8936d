// Linear statics.
#include "composition_lists.hpp"
#include "tissue_of.hpp"

namespace cross {

using namespace palpate;

template <>
struct SolverOf<Condensed<SelectiveInverse>> {
  static constexpr const char* word = "condensed";
};
template <>
struct SolverOf<Condensed<SelectiveInverseFloat>> {
  static constexpr const char* word = "condensed_float";
};
template <>
struct SolverOf<Condensed<DenseCholesky>> {
  static constexpr const char* word = "condensed_cholesky";
};
template <>
struct SolverOf<Condensed<ConjugateGradient>> {
  static constexpr const char* word = "condensed_cg";
};
template <>
struct SolverOf<SparseCholesky> {
  static constexpr const char* word = "sparse_cholesky";
};
template <>
struct SolverOf<ConjugateGradient> {
  static constexpr const char* word = "cg";
};
template <>
struct SolverOf<WithAssembly<ConjugateGradient, MatrixFree>> {
  static constexpr const char* word = "matrix_free_cg";
};
template <>
struct SolverOf<SelectiveInverse> {
  static constexpr const char* word = "inverse";
};

namespace {

template <class E>
void add_element(Compositions& all) {
  all.push_back(composition<E, LinearElastic, Condensed<SelectiveInverse>>());
  all.push_back(composition<E, LinearElastic, Condensed<SelectiveInverseFloat>>());
  all.push_back(composition<E, LinearElastic, Condensed<DenseCholesky>>());
  all.push_back(composition<E, LinearElastic, Condensed<ConjugateGradient>>());
  all.push_back(composition<E, LinearElastic, SparseCholesky>());
  all.push_back(composition<E, LinearElastic, ConjugateGradient>());
  all.push_back(composition<E, LinearElastic, WithAssembly<ConjugateGradient, MatrixFree>>());
  all.push_back(composition<E, LinearElastic, SelectiveInverse>());
  all.push_back(composition<E, TransverselyIsotropic, Condensed<SelectiveInverse>>());
  all.push_back(composition<E, Orthotropic, Condensed<SelectiveInverse>>());
}

}  // namespace

void add_static(Compositions& all) {
  add_element<Tet4>(all);
  add_element<Smoothed<Tet4>>(all);
  add_element<Tet10>(all);
  add_element<Hex8>(all);
  add_element<Hex20>(all);
  add_element<MeanDilatation<Hex8>>(all);
}

}  // namespace cross
