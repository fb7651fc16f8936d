// Dense linear algebra of the laws. Not templates: Eigen's decompositions take seconds to compile for every size.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/types.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// In ascending order. Only the lower triangle is read.
VectorX symmetric_eigenvalues(const MatrixX& symmetric);
MatrixX positive_definite_inverse(const MatrixX& positive_definite);
bool is_positive_definite(const MatrixX& symmetric);

}}}  // namespace palpate::testing

#if PALPATE_HEADER_ONLY
#include <palpate/testing/dense.ipp>
#endif
