// expect: LinearMaterial
// A 5 x 5 matrix is convertible to a 6 x 6 one in C++.
#include <palpate/material/linear_elastic.hpp>

using namespace palpate;

struct Shell : LinearElastic {
#ifdef PALPATE_GOOD_TWIN
  Matrix6 elasticity() const;
#else
  Eigen::Matrix<double, 5, 5> elasticity() const;
#endif
};

template <LinearMaterial M>
double first_modulus(const M& m) {
  return m.elasticity()(0, 0);
}

double modulus(const Shell& m) {
  return first_modulus(m);
}
