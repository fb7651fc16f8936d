// Definitions of element_frequency.hpp.
#pragma once

#include <palpate/assembly/element_frequency.hpp>

#include <Eigen/Eigenvalues>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE double largest_symmetric_eigenvalue(const MatrixX& symmetric) {
  return Eigen::SelfAdjointEigenSolver<MatrixX>(symmetric, Eigen::EigenvaluesOnly).eigenvalues().maxCoeff();
}

}}}  // namespace palpate::detail
