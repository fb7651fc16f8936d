// Linear statics that are cut.
#include "composition_lists.hpp"
#include "tissue_of.hpp"

#include <palpate/cut/cuttable.hpp>

namespace cross {

using namespace palpate;

using CutCondensed = Cuttable<Condensed<SelectiveInverse>>;

template <>
struct SolverOf<CutCondensed> {
  static constexpr const char* word = "cut_condensed";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene&, const Body&, const Construct& construct) {
    return construct({});
  }
};

template <class E, class M>
struct Used<HapticFEModel<E, M, CutCondensed>> {
  using Type = CuttableTissue<E>;
};

void add_cut(Compositions& all) {
  all.push_back(composition<Tet4, LinearElastic, CutCondensed>());
  all.push_back(composition<Tet4, TransverselyIsotropic, CutCondensed>());
  all.push_back(composition<Tet10, LinearElastic, CutCondensed>());
  all.push_back(composition<Tet10, Orthotropic, CutCondensed>());
  all.push_back(composition<Hex8, LinearElastic, CutCondensed>());
  all.push_back(composition<Hex20, LinearElastic, CutCondensed>());
  all.push_back(composition<MeanDilatation<Hex8>, LinearElastic, CutCondensed>());
}

}  // namespace cross
