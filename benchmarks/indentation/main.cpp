// How right and how smooth the force of the tick is. Exits with 1 when it is not.
#include <cstdio>

#include "indentation.hpp"

int main() {
  const bool smooth = indentation::sliding_is_smooth();
  const bool right = indentation::force_converges();
  std::printf("\nsliding: %s, indentation: %s\n", smooth ? "pass" : "FAIL", right ? "pass" : "FAIL");
  return smooth && right ? 0 : 1;
}
