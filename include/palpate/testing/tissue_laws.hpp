// The laws of concepts/tissue_model.hpp. Its hooks are checked by the compiler.
#pragma once

#include <palpate/concepts/tissue_model.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/testing/dense.hpp>
#include <palpate/testing/violation.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <span>
#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace testing {

/// Allowed deviations of a tissue from its laws.
struct TissueClaims {
  double tolerance = 1e-10;  ///< relative to the largest compliance; 1e-4 suits a compliance stored in float
};

/// The compliance between some vertices whose columns are available, 3 rows and columns per vertex [m/N].
template <TissueModel T>
MatrixX compliance_matrix(const T& tissue, std::span<const int> vertices) {
  const Index n = static_cast<Index>(vertices.size());
  MatrixX c(3 * n, 3 * n);
  for (Index i = 0; i < n; ++i)
    for (Index j = 0; j < n; ++j)
      c.block<3, 3>(3 * i, 3 * j) =
          tissue.compliance(vertices[static_cast<std::size_t>(i)], vertices[static_cast<std::size_t>(j)]);
  return c;
}

/// "bound really bounds": no vertex of the whole surface moves farther per unit force than the bound of the loaded
/// vertex (measured by the largest singular value of the 3 x 3 block).
template <TissueModel T>
Violations bound_laws(const T& tissue, std::span<const int> vertices) {
  Violations v;
  Worst worst("bound really bounds", 1.0 + 1e-12);
  for (int j : vertices)
    for (int i = 0; i < tissue.contact_surface().vertex_count(); ++i) {
      const Matrix3 c = tissue.compliance(i, j);
      const double squared = symmetric_eigenvalues(c.transpose() * c)[2];
      const double moved = std::sqrt(std::max(squared, 0.0)), bound = tissue.compliance_bound(j);
      worst.observe(moved == 0.0 ? 0.0 : moved / bound,
                    [i, j] { return "vertex " + std::to_string(i) + " loaded at " + std::to_string(j); });
    }
  worst.report(v);
  return v;
}

/// "floor is positive" and "floor is tiny" against every vertex that can move; "pose is rigid".
template <TissueModel T>
Violations scale_laws(const T& tissue, std::span<const int> vertices) {
  Violations v;
  const double floor = tissue.compliance_floor();
  expect_above(v, "floor is positive", floor, 0.0);
  for (int j : vertices)
    if (const double bound = tissue.compliance_bound(j); bound > 0.0)
      expect_at_most(v, "floor is tiny", floor, 1e-6 * bound, "vertex " + std::to_string(j));
  const Matrix3 r = tissue.to_world().linear();
  expect_at_most(v, "pose is rigid", (r.transpose() * r - Matrix3::Identity()).norm(), 1e-12);
  expect_above(v, "pose is rigid", r.determinant(), 0.0);
  expect_true(v, "pose is rigid", tissue.to_world().matrix().allFinite(), "translation");
  return v;
}

/// Laws for the given vertices, whose columns must all be available simultaneously: "columns available", "finite",
/// "reciprocity" (C(i, j) = C(j, i)^T, Betti), "positive semidefinite" and "a loaded vertex moves" where it is not
/// constrained, the bound, the floor, and "same columns again". At least one of the vertices must be able to move.
template <TissueModel T>
Violations tissue_laws(T& tissue, std::span<const int> vertices, TissueClaims claims = {}) {
  Violations v;
  expect_true(v, "columns available", tissue.require_columns(vertices).ok());
  const MatrixX c = compliance_matrix(tissue, vertices);
  expect_true(v, "finite", c.allFinite());
  if (!c.allFinite() || c.size() == 0) return v;
  const double scale = c.cwiseAbs().maxCoeff();
  expect_above(v, "something gives way", scale, 0.0);
  expect_at_most(v, "reciprocity", (c - c.transpose()).cwiseAbs().maxCoeff(), claims.tolerance * scale);
  const VectorX eigenvalues = symmetric_eigenvalues(0.5 * (c + c.transpose()));
  expect_at_least(v, "positive semidefinite", eigenvalues[0], -claims.tolerance * eigenvalues.tail<1>()[0]);
  for (std::size_t i = 0; i < vertices.size(); ++i) {
    const VectorX own = c.diagonal().segment<3>(3 * static_cast<Index>(i));
    const MatrixX column = c.middleCols<3>(3 * static_cast<Index>(i));
    if (!column.isZero(0.0))
      expect_at_least(v, "a loaded vertex moves", own.minCoeff(), 0.0, "vertex " + std::to_string(i));
    if (!column.isZero(0.0))
      expect_above(v, "a loaded vertex moves", own.maxCoeff(), 0.0, "vertex " + std::to_string(i));
  }
  append(v, bound_laws(tissue, vertices));
  append(v, scale_laws(tissue, vertices));
  tissue.require_columns(vertices);
  expect_true(v, "same columns again", compliance_matrix(tissue, vertices) == c);
  return v;
}

}}}  // namespace palpate::testing
