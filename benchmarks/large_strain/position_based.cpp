// Position-based constraints, as a baseline.
#include "pressed_block.hpp"

namespace large_strain {
namespace {

/// XPBD in small steps of one sweep each (Macklin et al. 2019), with the constraints of stable neo-Hookean tetrahedra
/// (Macklin and Mueller 2021), both of an element solved together: |F| with compliance 1/(mu V), and
/// det F - 1 - mu/lambda with compliance 1/(lambda V).
class PositionBasedBlock : public Method {
 public:
  PositionBasedBlock(const PressedBlock& block, int substeps)
      : mesh_(block.mesh), square_(block.square), substeps_(substeps), place_(mesh_.positions), before_(place_) {
    velocity_.assign(place_.size(), Vector3::Zero());
    for (const double m : lumped_mass(make_body(mesh_, std::vector{bench::tissue}))) inverse_mass_.push_back(1.0 / m);
    for (const auto* list : {&block.bottom, &block.square})
      for (const NodeId i : *list) inverse_mass_[static_cast<std::size_t>(i)] = 0.0;
    for (Index e = 0; e < mesh_.element_count(); ++e) geometry_.push_back(detail::constant_geometry<Tet4>(mesh_, e));
  }
  void step(const Vector3& square) override {
    const double dt = step_length / substeps_;
    const Vector3 from = std::exchange(moved_, square);
    for (int s = 1; s <= substeps_; ++s) {
      before_ = place_;
      for (std::size_t i = 0; i < place_.size(); ++i) place_[i] += dt * velocity_[i];
      for (const NodeId i : square_)
        place_[static_cast<std::size_t>(i)] =
            mesh_.position(Index{i}) + from + static_cast<double>(s) / substeps_ * (square - from);
      for (Index e = 0; e < mesh_.element_count(); ++e) solve(e, dt);
      for (std::size_t i = 0; i < place_.size(); ++i)
        velocity_[i] = inverse_mass_[i] > 0.0 ? Vector3((place_[i] - before_[i]) / dt) : Vector3::Zero();
    }
  }
  Vector3 force() override {
    return elastic_force(
        mesh_, square_, [&](NodeId i) { return place_[static_cast<std::size_t>(i)]; }, law_);
  }

 private:
  void solve(Index e, double dt) {
    const auto& g = geometry_[static_cast<std::size_t>(e)];
    Matrix3 f = Matrix3::Zero();
    for (int a = 0; a < 4; ++a) f += place_[node(e, a)] * g.gradient.row(a);
    const Matrix3 c = StableNeoHookean::cofactor(f);
    const double length = f.norm();
    const Eigen::Matrix<double, 3, 4> shape = f / length * g.gradient.transpose(), size = c * g.gradient.transpose();
    Eigen::Matrix2d a = Eigen::Matrix2d::Zero();
    a.diagonal() << 1.0 / (law_.mu * g.volume * dt * dt), 1.0 / (law_.lambda * g.volume * dt * dt);
    for (int k = 0; k < 4; ++k) {
      const double w = inverse_mass_[node(e, k)];
      a(0, 0) += w * shape.col(k).squaredNorm();
      a(1, 1) += w * size.col(k).squaredNorm();
      a(0, 1) += w * shape.col(k).dot(size.col(k));
    }
    a(1, 0) = a(0, 1);
    const Vector2 multiplier = -a.inverse() * Vector2(length, f.determinant() - 1.0 - law_.mu / law_.lambda);
    for (int k = 0; k < 4; ++k)
      place_[node(e, k)] += inverse_mass_[node(e, k)] * (multiplier[0] * shape.col(k) + multiplier[1] * size.col(k));
  }
  std::size_t node(Index e, int a) const { return static_cast<std::size_t>(mesh_.element_node(e, a)); }

  Mesh<Tet4> mesh_;
  std::vector<NodeId> square_;
  int substeps_;
  std::vector<Vector3> place_, before_, velocity_;
  std::vector<double> inverse_mass_;
  std::vector<decltype(detail::constant_geometry<Tet4>(std::declval<Mesh<Tet4>>(), 0))> geometry_;
  Vector3 moved_ = Vector3::Zero();
  StableNeoHookean law_;
};

}  // namespace

void add_position_based(std::vector<Entry>& entries) {
  for (const auto& [substeps, colour] : {std::pair{1, "#f90"}, {5, "#e60"}, {20, "#b30"}})
    entries.push_back(
        {"XPBD, " + std::to_string(substeps) + (substeps > 1 ? " sweeps a step" : " sweep a step"), colour,
         [substeps](const PressedBlock& block) { return std::make_unique<PositionBasedBlock>(block, substeps); }});
}

}  // namespace large_strain
