// Accuracy and smoothness of the rendered force, for every element. Exits with 1 when a check fails.
#include <palpate/element/wrappers.hpp>

#include <cstdio>

#include "indentation.hpp"

int main() {
  using namespace palpate;
  const bool smooth = indentation::sliding_is_smooth();
  bool right = indentation::force_converges<Tet4>("Tet4");
  right = indentation::force_converges<Smoothed<Tet4>>("Smoothed<Tet4>") && right;
  right = indentation::force_converges<Tet10>("Tet10") && right;
  right = indentation::force_converges<Hex8>("Hex8") && right;
  right = indentation::force_converges<MeanDilatation<Hex8>>("MeanDilatation<Hex8>") && right;
  std::printf("\nsliding: %s, indentation: %s\n", smooth ? "pass" : "FAIL", right ? "pass" : "FAIL");
  return smooth && right ? 0 : 1;
}
