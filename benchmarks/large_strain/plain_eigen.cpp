// Newton's method with Eigen's sparse factorisation, as a baseline.
#include "pressed_block.hpp"

#include <Eigen/SparseCholesky>

namespace large_strain {
namespace {

/// Implicit Euler with linear tetrahedra: Newton's method with a factorisation per iteration, the exact tangent at
/// precomputed positions, a shift where it is indefinite, and halved steps until the potential falls.
class NewtonBlock : public Method {
 public:
  explicit NewtonBlock(const PressedBlock& block) : mesh_(block.mesh), square_(block.square) {
    const auto nodes = static_cast<std::size_t>(mesh_.node_count());
    dof_.assign(nodes, 0);
    for (const auto* list : {&block.bottom, &block.square})
      for (const NodeId i : *list) dof_[static_cast<std::size_t>(i)] = -1;
    int count = 0;
    for (int& d : dof_)
      if (d >= 0) d = std::exchange(count, count + 3);
    for (Index e = 0; e < mesh_.element_count(); ++e) geometry_.push_back(detail::constant_geometry<Tet4>(mesh_, e));
    mass_ = lumped_mass(make_body(mesh_, std::vector{bench::tissue}));
    x_ = Eigen::Map<const VectorX>(mesh_.positions.front().data(), 3 * mesh_.node_count());
    v_ = VectorX::Zero(x_.size());
    std::vector<Eigen::Triplet<double>> entries;
    visit_entries([&](int row, int column, Index, int, int) { entries.emplace_back(row, column, 1.0); });
    k_.resize(count, count);
    k_.setFromTriplets(entries.begin(), entries.end());
    visit_entries([&](int row, int column, Index, int, int) {
      place_.push_back(static_cast<Index>(&k_.coeffRef(row, column) - k_.valuePtr()));
    });
    for (int i = 0; i < count; ++i) diagonal_.push_back(static_cast<Index>(&k_.coeffRef(i, i) - k_.valuePtr()));
    solver_.analyzePattern(k_);
  }

  void step(const Vector3& square) override {
    const VectorX before = x_;
    for (const NodeId i : square_) x_.segment<3>(3 * Index{i}) = mesh_.position(Index{i}) + square;
    predicted_ = x_;
    for (std::size_t i = 0; i < dof_.size(); ++i)
      if (dof_[i] >= 0)
        predicted_.segment<3>(3 * static_cast<Index>(i)) += step_length * v_.segment<3>(3 * static_cast<Index>(i));
    VectorX residual(k_.rows()), d;
    for (int iteration = 0; iteration < most_iterations; ++iteration) {
      const double potential = evaluate(residual);
      if (iteration > 0 && residual.norm() <= tolerance * scale_) break;
      if (!factorise()) break;
      d = solver_.solve(residual);
      const VectorX start = x_;
      for (double part = 1.0; part > 1e-3; part *= 0.5) {
        x_ = start;
        add(part, d);
        if (potential_at() <= potential) break;
      }
    }
    v_ = (x_ - before) / step_length;
  }
  Vector3 force() override {
    return elastic_force(
        mesh_, square_, [&](NodeId i) { return node(i); }, law_);
  }

 private:
  static constexpr int most_iterations = 10;
  static constexpr double tolerance = 5e-3;  // as in palpate

  Vector3 node(NodeId i) const { return x_.segment<3>(3 * Index{i}); }
  Matrix3 deformation(Index e) const {
    Matrix3 f = Matrix3::Zero();
    for (int a = 0; a < 4; ++a)
      f += node(mesh_.element_node(e, a)) * geometry_[static_cast<std::size_t>(e)].gradient.row(a);
    return f;
  }
  /// Calls visit(row, column, element, i, j) for all entries (i, j) of element matrices in the lower half.
  template <class Visit>
  void visit_entries(Visit&& visit) {
    for (Index e = 0; e < mesh_.element_count(); ++e)
      for (int i = 0; i < 12; ++i)
        for (int j = 0; j < 12; ++j) {
          const int row = dof_[static_cast<std::size_t>(mesh_.element_node(e, i / 3))],
                    column = dof_[static_cast<std::size_t>(mesh_.element_node(e, j / 3))];
          if (row >= 0 && column >= 0 && row + i % 3 >= column + j % 3) visit(row + i % 3, column + j % 3, e, i, j);
        }
  }
  double potential_at() const {
    double sum = 0.0;
    for (Index e = 0; e < mesh_.element_count(); ++e)
      sum += geometry_[static_cast<std::size_t>(e)].volume * law_.energy(deformation(e));
    for (Index i = 0; i < mass_.size(); ++i)
      sum += 0.5 * mass_[i] / (step_length * step_length) *
             (x_.segment<3>(3 * i) - predicted_.segment<3>(3 * i)).squaredNorm();
    return sum;
  }
  double evaluate(VectorX& residual) {
    VectorX f = VectorX::Zero(x_.size());
    for (Index e = 0; e < mesh_.element_count(); ++e) {
      const auto& g = geometry_[static_cast<std::size_t>(e)];
      const Matrix3 stress = g.volume * law_(deformation(e));
      for (int a = 0; a < 4; ++a)
        f.segment<3>(3 * Index{mesh_.element_node(e, a)}) += stress * g.gradient.row(a).transpose();
    }
    scale_ = f.norm();
    for (Index i = 0; i < mass_.size(); ++i)
      f.segment<3>(3 * i) +=
          mass_[i] / (step_length * step_length) * (x_.segment<3>(3 * i) - predicted_.segment<3>(3 * i));
    for (std::size_t i = 0; i < dof_.size(); ++i)
      if (dof_[i] >= 0) residual.segment<3>(dof_[i]) = -f.segment<3>(3 * static_cast<Index>(i));
    return potential_at();
  }
  bool factorise() {
    std::fill_n(k_.valuePtr(), k_.nonZeros(), 0.0);
    std::size_t next = 0;
    Index last = -1;
    Eigen::Matrix<double, 12, 12> k;
    visit_entries([&](int, int, Index e, int i, int j) {
      if (e != last) element_tangent(last = e, k);
      k_.valuePtr()[place_[next++]] += k(i, j);
    });
    double largest = 0.0;
    for (std::size_t i = 0; i < dof_.size(); ++i)
      for (int c = 0; dof_[i] >= 0 && c < 3; ++c) {
        double& entry = k_.valuePtr()[diagonal_[static_cast<std::size_t>(dof_[i] + c)]];
        entry += mass_[static_cast<Index>(i)] / (step_length * step_length);
        largest = std::max(largest, entry);
      }
    for (double shift = 0.0; shift < largest; shift = std::max(1e-3 * largest, 4.0 * shift)) {
      for (const Index at : diagonal_) k_.valuePtr()[at] += shift;
      solver_.factorize(k_);
      if (solver_.info() == Eigen::Success && solver_.vectorD().minCoeff() > 0.0) return true;
    }
    return false;
  }
  void element_tangent(Index e, Eigen::Matrix<double, 12, 12>& k) const {
    const auto& g = geometry_[static_cast<std::size_t>(e)];
    const Matrix3 f = deformation(e);
    const Eigen::Matrix<double, 3, 4> c = StableNeoHookean::cofactor(f) * g.gradient.transpose();
    const double pressure = law_.pressure(f);
    for (int a = 0; a < 4; ++a)
      for (int b = 0; b < 4; ++b) {
        const Vector3 w = f * Vector3(g.gradient.row(a)).cross(Vector3(g.gradient.row(b)));
        Matrix3 cross;
        cross << 0.0, w.z(), -w.y(), -w.z(), 0.0, w.x(), w.y(), -w.x(), 0.0;
        k.block<3, 3>(3 * a, 3 * b) =
            g.volume * (law_.mu * g.gradient.row(a).dot(g.gradient.row(b)) * Matrix3::Identity() +
                        law_.lambda * c.col(a) * c.col(b).transpose() + pressure * cross);
      }
  }
  void add(double part, const VectorX& d) {
    for (std::size_t i = 0; i < dof_.size(); ++i)
      if (dof_[i] >= 0) x_.segment<3>(3 * static_cast<Index>(i)) += part * d.segment<3>(dof_[i]);
  }

  Mesh<Tet4> mesh_;
  std::vector<NodeId> square_;
  StableNeoHookean law_;
  std::vector<int> dof_;  // first free dof of every node, -1 for prescribed ones
  std::vector<decltype(detail::constant_geometry<Tet4>(std::declval<Mesh<Tet4>>(), 0))> geometry_;
  VectorX mass_, x_, v_, predicted_;
  SparseMatrix k_;
  std::vector<Index> place_, diagonal_;
  Eigen::SimplicialLDLT<SparseMatrix> solver_;
  double scale_ = 0.0;
};

}  // namespace

void add_plain_eigen(std::vector<Entry>& entries) {
  entries.push_back({"plain Eigen, Newton, Tet4", "#888",
                     [](const PressedBlock& block) { return std::make_unique<NewtonBlock>(block); }, 12});
}

}  // namespace large_strain
