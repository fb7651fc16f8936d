// expect: Smoothed and MeanDilatation average small strains
#include <palpate/assembly/large_strain.hpp>
#include <palpate/element/tet4.hpp>
#include <palpate/material/neo_hookean.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Chosen = Tet4;
#else
using Chosen = Smoothed<Tet4>;
#endif

Index dofs_of(const LargeStrain<Chosen, NeoHookean>& body) {
  return body.size();
}
