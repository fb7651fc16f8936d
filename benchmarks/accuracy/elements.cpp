#include "elements.hpp"

namespace accuracy {

const Solvers<Elements>& solvers() {
  static const Solvers<Elements> all;
  return all;
}

}  // namespace accuracy
