// expect: FibreMaterial
// A 5 x 5 matrix is convertible to a 6 x 6 one in C++.
#include <palpate/material/orthotropic.hpp>

using namespace palpate;

struct Shell : TransverselyIsotropic {
  Matrix6 elasticity() const;
#ifdef PALPATE_GOOD_TWIN
  Matrix6 elasticity(const Vector3&) const;
#else
  Eigen::Matrix<double, 5, 5> elasticity(const Vector3&) const;
#endif
};

template <FibreMaterial M>
double first_modulus(const M& m) {
  return m.elasticity(Vector3::UnitX())(0, 0);
}

double modulus(const Shell& m) {
  return first_modulus(m);
}
