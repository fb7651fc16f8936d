// expect: Smoothed and MeanDilatation average small strains
#include <palpate/assembly/large_strain.hpp>
#include <palpate/element/hex8.hpp>
#include <palpate/material/neo_hookean.hpp>

using namespace palpate;

#ifdef PALPATE_GOOD_TWIN
using Chosen = Hex8;
#else
using Chosen = MeanDilatation<Hex8>;
#endif

Index dofs_of(const LargeStrain<Chosen, NeoHookean>& body) {
  return body.size();
}
