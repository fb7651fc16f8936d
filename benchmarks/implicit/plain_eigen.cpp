#include "implicit.hpp"

#include <Eigen/Geometry>
#include <Eigen/IterativeLinearSolvers>

namespace implicit_path {

PlainEigenStep::PlainEigenStep(const Pressing& pressing, double tolerance) : tolerance_(tolerance) {
  const Mesh<Tet4>& mesh = pressing.body.rest.mesh;
  conditions_ = resolve_essential(mesh, extract_boundary<Tet4>(mesh), pressing.scene);
  const VectorX nodal = lumped_mass(pressing.body.rest);
  mass_ = nodal.replicate(1, 3).transpose().reshaped();
  load_ = VectorX::Zero(mass_.size());
  for (Index i = 0; i < nodal.size(); ++i) load_.segment<3>(3 * i) = nodal[i] * pressing.scene.gravity();
  u_ = v_ = VectorX::Zero(mass_.size());
  std::vector<Eigen::Triplet<double>> entries;
  for (Index e = 0; e < mesh.element_count(); ++e) {
    Element& element = elements_.emplace_back();
    const auto g = detail::constant_geometry<Tet4>(mesh, e);
    element.gradient = g.gradient;
    element.volume = g.volume;
    Eigen::Matrix<double, 6, 12> b = Eigen::Matrix<double, 6, 12>::Zero();  // xx yy zz xy yz zx
    for (int a = 0; a < 4; ++a) {
      element.nodes[static_cast<std::size_t>(a)] = mesh.element_node(e, a);
      const Vector3 n = g.gradient.row(a);
      b.col(3 * a) << n.x(), 0, 0, n.y(), 0, n.z();
      b.col(3 * a + 1) << 0, n.y(), 0, n.x(), n.z(), 0;
      b.col(3 * a + 2) << 0, 0, n.z(), 0, n.y(), n.x();
    }
    const double mu = bench::tissue.shear_modulus();
    Matrix6 d = Matrix6::Zero();  // the part of lambda follows the deformation, see add
    d.diagonal() << 2 * mu, 2 * mu, 2 * mu, mu, mu, mu;
    element.stiffness = g.volume * b.transpose() * d * b;
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) {
        const Index row = conditions_.free_index[static_cast<std::size_t>(
                        3 * Index{element.nodes[static_cast<std::size_t>(i / 3)]} + i % 3)],
                    column = conditions_.free_index[static_cast<std::size_t>(
                        3 * Index{element.nodes[static_cast<std::size_t>(j / 3)]} + j % 3)];
        if (row >= 0 && column >= 0) entries.emplace_back(static_cast<int>(row), static_cast<int>(column), 1.0);
      }
  }
  a_.resize(conditions_.free_count(), conditions_.free_count());
  a_.setFromTriplets(entries.begin(), entries.end());
  const auto place = [&](Index row, Index column) {
    return static_cast<Index>(&a_.coeffRef(row, column) - a_.valuePtr());
  };
  for (Element& element : elements_)
    for (int i = 0; i < 12; ++i)
      for (int j = 0; j < 12; ++j) {
        const auto dof = [&](int k) {
          return conditions_
              .free_index[static_cast<std::size_t>(3 * Index{element.nodes[static_cast<std::size_t>(k / 3)]} + k % 3)];
        };
        element.place[static_cast<std::size_t>(i + 12 * j)] =
            dof(i) >= 0 && dof(j) >= 0 ? place(dof(i), dof(j)) : Index{-1};
      }
  for (Index i = 0; i < a_.rows(); ++i) diagonal_.push_back(place(i, i));
}

void PlainEigenStep::rotate(Element& e) const {
  Matrix3 f = Matrix3::Identity();
  for (int a = 0; a < 4; ++a) f += u_.segment<3>(3 * Index{e.nodes[static_cast<std::size_t>(a)]}) * e.gradient.row(a);
  for (int k = 0; k < 20; ++k) {
    const Matrix3 r = e.rotation.matrix();
    const Vector3 omega = (r.col(0).cross(f.col(0)) + r.col(1).cross(f.col(1)) + r.col(2).cross(f.col(2))) /
                          (std::abs(r.col(0).dot(f.col(0)) + r.col(1).dot(f.col(1)) + r.col(2).dot(f.col(2))) + 1e-9);
    const double angle = omega.norm();
    if (angle < 1e-6) break;
    e.rotation = Eigen::Quaterniond(Eigen::AngleAxisd(angle, omega / angle)) * e.rotation;
    e.rotation.normalize();
  }
}

void PlainEigenStep::add(Element& e, const VectorX& predicted, VectorX& residual) {
  const Matrix3 r = e.rotation.matrix();
  Matrix12 rotated;
  for (int i = 0; i < 4; ++i)
    for (int j = 0; j < 4; ++j)
      rotated.block<3, 3>(3 * i, 3 * j).noalias() = r * e.stiffness.block<3, 3>(3 * i, 3 * j) * r.transpose();
  Matrix3 f = Matrix3::Identity(), cofactor;
  for (int a = 0; a < 4; ++a)
    f += predicted.segment<3>(3 * Index{e.nodes[static_cast<std::size_t>(a)]}) * e.gradient.row(a);
  cofactor << f.col(1).cross(f.col(2)), f.col(2).cross(f.col(0)), f.col(0).cross(f.col(1));
  const double lambda = bench::tissue.lame_lambda(), mu = bench::tissue.shear_modulus();
  const Matrix3 stress = e.volume * (2.0 * mu * (f - r) + lambda * (f.determinant() - 1.0) * cofactor);
  Eigen::Matrix<double, 12, 1> volume_change;
  for (int a = 0; a < 4; ++a) {
    residual.segment<3>(3 * Index{e.nodes[static_cast<std::size_t>(a)]}) -= stress * e.gradient.row(a).transpose();
    volume_change.segment<3>(3 * a) = cofactor * e.gradient.row(a).transpose();
  }
  rotated.noalias() += e.volume * lambda * volume_change * volume_change.transpose();
  double* const values = a_.valuePtr();
  for (int k = 0; k < 144; ++k)
    if (const Index at = e.place[static_cast<std::size_t>(k)]; at >= 0) values[at] += rotated.data()[k];
}

void PlainEigenStep::step(double h, const VectorX& prescribed) {
  VectorX predicted = u_ + h * v_;
  for (Index dof = 0; dof < predicted.size(); ++dof)
    if (conditions_.is_constrained(dof)) predicted[dof] = prescribed[dof];
  const VectorX before = u_;
  u_ = predicted;
  std::fill_n(a_.valuePtr(), a_.nonZeros(), 0.0);
  VectorX residual = load_;
  for (Element& e : elements_) {
    rotate(e);
    add(e, predicted, residual);
  }
  for (Index i = 0; i < a_.rows(); ++i)
    a_.valuePtr()[diagonal_[static_cast<std::size_t>(i)]] +=
        mass_[conditions_.free_dofs[static_cast<std::size_t>(i)]] / (h * h);
  VectorX b(a_.rows());
  conditions_.gather(residual, b);
  Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper> solver;
  solver.setTolerance(tolerance_);
  solver.compute(a_);
  const VectorX x = solver.solve(b);
  iterations_ += solver.iterations();
  for (Index i = 0; i < x.size(); ++i) u_[conditions_.free_dofs[static_cast<std::size_t>(i)]] += x[i];
  v_ = (u_ - before) / h;
}

}  // namespace implicit_path
