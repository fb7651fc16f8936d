// Linear statics along stiffening curves.
#include "composition_lists.hpp"
#include "tissue_of.hpp"

#include <palpate/model/static/stiffening.hpp>

namespace cross {

using namespace palpate;

using Stiffened = Stiffening<Condensed<SelectiveInverse>>;

template <>
inline constexpr bool takes_cache<Stiffened> = true;  // that of the solver inside

/// Half as stiff again at a tenth of the size of the body, a fifth across.
template <>
struct SolverOf<Stiffened> {
  static constexpr const char* word = "stiffening";
  template <class Model, class Construct>
  static std::unique_ptr<Model> make(const Scene&, const Body& body, const Construct& construct) {
    const double far = 0.1 * body.size;
    return construct(
        {.axial = StiffeningCurve({{0.0, 1.0}, {far, 1.5}}), .radial = StiffeningCurve({{0.0, 1.0}, {far, 1.2}})});
  }
};

void add_stiffening(Compositions& all) {
  all.push_back(composition<Tet4, LinearElastic, Stiffened>());
  all.push_back(composition<Smoothed<Tet4>, LinearElastic, Stiffened>());
  all.push_back(composition<Tet10, LinearElastic, Stiffened>());
  all.push_back(composition<Hex8, LinearElastic, Stiffened>());
}

}  // namespace cross
