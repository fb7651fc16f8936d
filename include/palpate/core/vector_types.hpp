// Types of vectors, matrices and indices.
#pragma once

#include <palpate/core/config.hpp>

#include <cstdint>

namespace palpate { inline namespace PALPATE_ABI {

/// Counts and offsets. 64 bits, because (3 x surface nodes)^2 overflows 32 bits from 15 447 nodes on.
using Index = std::int64_t;
/// A node of a mesh, as stored in connectivity.
using NodeId = std::int32_t;

using Vector2 = Eigen::Vector2d;
using Vector3 = Eigen::Vector3d;
using Matrix3 = Eigen::Matrix3d;
/// Stress or strain in Voigt order (core/voigt.hpp).
using Vector6 = Eigen::Matrix<double, 6, 1>;
/// Elasticity matrix in Voigt order.
using Matrix6 = Eigen::Matrix<double, 6, 6>;
/// Derivative of one 3 x 3 tensor by another, both in column-major order (core/tensor3.hpp).
using Matrix9 = Eigen::Matrix<double, 9, 9>;
using VectorX = Eigen::VectorXd;
using MatrixX = Eigen::MatrixXd;

}}  // namespace palpate
