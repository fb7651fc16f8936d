// The sampled loop of handle, zero-order hold and delay line as a state matrix.
#include "stability.hpp"

#include <Eigen/Eigenvalues>

namespace stability {
namespace {

/// exp(a) by scaling and squaring: the argument is halved until the series converges fast.
Matrix3 exponential(Matrix3 a) {
  int halvings = 0;
  for (; a.cwiseAbs().maxCoeff() > 1e-2; ++halvings) a *= 0.5;
  Matrix3 sum = Matrix3::Identity(), term = sum;
  for (int n = 1; n < 12; ++n) sum += term = term * a / n;
  for (; halvings > 0; --halvings) sum = sum * sum;
  return sum;
}

/// Spectral radius of the loop. State: position, velocity, and the delayed forces, oldest first.
double spectral_radius(const SimulatedOptions& o, int delay, double stiffness) {
  const double m = o.mass + o.hand.mass;
  Matrix3 flow = Matrix3::Zero();  // of position, velocity and a constant force
  flow << 0.0, 1.0, 0.0, -o.hand.stiffness / m, -(o.damping + o.hand.damping) / m, 1.0 / m, 0.0, 0.0, 0.0;
  const Matrix3 over = exponential(flow / o.rate);
  MatrixX loop = MatrixX::Zero(2 + delay, 2 + delay);
  loop.topLeftCorner(2, 2) = over.topLeftCorner(2, 2);
  if (delay == 0) {
    loop.col(0) -= stiffness * over.col(2).head<2>();
  } else {
    loop.block<2, 1>(0, 2) = over.col(2).head<2>();
    for (int i = 0; i + 1 < delay; ++i) loop(2 + i, 3 + i) = 1.0;
    loop(1 + delay, 0) = -stiffness;
  }
  return Eigen::EigenSolver<MatrixX>(loop, false).eigenvalues().cwiseAbs().maxCoeff();
}

}  // namespace

double limit_by_eigenvalues(const SimulatedOptions& device, int delay_ticks) {
  const auto stable = [&](double stiffness) { return spectral_radius(device, delay_ticks, stiffness) < 1.0; };
  return testing::largest_that(stable, 1e-3, 1e8, 1e-5);
}

}  // namespace stability
