// A straightforward implementation with Eigen: linear tetrahedra on the given mesh, solved in every tick; and the same
// at a lower rate, with forces interpolated for the device.
#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/free_stiffness.hpp>

#include <Eigen/IterativeLinearSolvers>
#include <Eigen/SparseCholesky>

#include "linear.hpp"
#include "push_apart.hpp"

namespace tradeoff {
namespace {

using Ldlt = Eigen::SimplicialLDLT<SparseMatrix>;
using Gradients = Eigen::ConjugateGradient<SparseMatrix, Eigen::Lower | Eigen::Upper>;

/// Nodes are kept outside the spheres along the normals of the last tick: one solve per node, and a small contact
/// problem by projected Gauss-Seidel.
template <class Solver>
class EveryTick : public Contender {
 public:
  EveryTick(const Bench& bench, const Mesh<Tet4>& mesh) : bench_(bench), mesh_(mesh) {
    conditions_ = resolve_essential(mesh, extract_boundary<Tet4>(mesh), bench.scene.scene(near_group));
    const SparseMatrix lower =
        free_matrix(assemble_stiffness<Tet4>(make_body(mesh, bench.scene.materials), {}), conditions_);
    stiffness_ = lower.selfadjointView<Eigen::Lower>();
    if constexpr (std::same_as<Solver, Gradients>) solver_.setTolerance(1e-4);
    solver_.compute(stiffness_);
    if (solver_.info() != Eigen::Success) raise(SetupErrorKind::not_positive_definite, "Eigen's solver failed");
    for (const NodeId node : mesh.find_group(near_group)->nodes)
      if (!conditions_.is_constrained(3 * Index{node})) nodes_.push_back(node);
    columns_.assign(nodes_.size(), VectorX::Zero(stiffness_.rows()));
    forces_.assign(bench.scene.spheres.size(), Vector3::Zero());
    u_ = VectorX::Zero(stiffness_.rows());
  }

  std::span<const Vector3> tick(std::span<const Vector3> centres) override {
    find_rows(centres);
    for (Point& row : rows_) {
      VectorX load = VectorX::Zero(u_.size());
      load.segment<3>(row.at) = row.normal;
      if constexpr (std::same_as<Solver, Gradients>)
        columns_[row.node] = solver_.solveWithGuess(load, columns_[row.node]);
      else
        columns_[row.node] = solver_.solve(load);
    }
    MatrixX w(rows_.size(), rows_.size());
    VectorX gap(rows_.size());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      gap[static_cast<Index>(i)] = rows_[i].gap;
      for (std::size_t j = 0; j < rows_.size(); ++j)
        w(static_cast<Index>(i), static_cast<Index>(j)) =
            rows_[i].normal.dot(columns_[rows_[j].node].template segment<3>(rows_[i].at));
    }
    VectorX lambda = VectorX::Zero(gap.size());
    push_apart(w, gap, lambda, {.sweeps = 500, .tolerance = 1e-6});
    u_.setZero();
    std::ranges::fill(forces_, Vector3::Zero());
    for (std::size_t i = 0; i < rows_.size(); ++i) {
      u_ += lambda[static_cast<Index>(i)] * columns_[rows_[i].node];
      forces_[rows_[i].sphere] -= lambda[static_cast<Index>(i)] * rows_[i].normal;
    }
    return forces_;
  }
  VectorX displacement() override {
    VectorX u = VectorX::Zero(conditions_.dof_count());
    conditions_.scatter(u_, u);
    return u.head(3 * bench_.scene.mesh.node_count());
  }
  /// Difference of K u and the forces of the spheres, relative to these forces.
  double own_error() override {
    VectorX left = stiffness_ * u_;
    double size = 0.0;
    Vector3 sum = Vector3::Zero();
    for (std::size_t b = 0; b < forces_.size(); ++b) {
      sum += forces_[b];
      size += forces_[b].norm();
    }
    for (const Point& row : rows_)
      for (int c = 0; c < 3; ++c) {
        sum[c] += left[row.at + c];
        left[row.at + c] = 0.0;
      }
    return (sum.norm() + left.norm()) / size;
  }
  Index nodes() const override { return mesh_.node_count(); }

 private:
  struct Point {
    std::size_t node, sphere;
    Index at;
    Vector3 normal;
    double gap;
  };

  /// Finds nodes in or near a sphere at their present positions; gap [m] is the gap without forces, along the present
  /// normal.
  void find_rows(std::span<const Vector3> centres) {
    rows_.clear();
    for (std::size_t k = 0; k < nodes_.size(); ++k)
      for (std::size_t b = 0; b < centres.size(); ++b) {
        const Index at = conditions_.free_index[static_cast<std::size_t>(3 * Index{nodes_[k]})];
        const Vector3 moved = u_.segment<3>(at), off = mesh_.position(nodes_[k]) + moved - centres[b];
        const double distance = off.norm();
        if (distance > bench_.scene.radius + 1e-3 || distance == 0.0) continue;
        const Vector3 normal = off / distance;
        rows_.push_back({k, b, at, normal, distance - bench_.scene.radius - normal.dot(moved)});
      }
  }
  const Bench& bench_;
  const Mesh<Tet4>& mesh_;
  EssentialConditions conditions_;
  SparseMatrix stiffness_;
  Solver solver_;
  std::vector<NodeId> nodes_;
  std::vector<VectorX> columns_;
  std::vector<Point> rows_;
  std::vector<Vector3> forces_;
  VectorX u_;
};

/// A slow model in a background thread; the device renders an interpolation between its last two forces (Fagerholt
/// 2005, chapter 1): smooth, but delayed by an update.
class Interpolated : public Contender {
 public:
  Interpolated(std::unique_ptr<Contender> slow, double period, std::size_t spheres)
      : slow_(std::move(slow)), period_(period), from_(spheres, Vector3::Zero()), to_(from_), forces_(from_) {}

  std::span<const Vector3> tick(std::span<const Vector3> centres) override {
    centres_.assign(centres.begin(), centres.end());
    ++since_;
    const double t = std::min(1.0, since_ / std::max(1.0, gap_));
    for (std::size_t b = 0; b < forces_.size(); ++b) forces_[b] = (1.0 - t) * from_[b] + t * to_[b];
    return forces_;
  }
  double update_period() const override { return period_; }
  void update() override {
    if (centres_.empty()) return;
    const auto fresh = slow_->tick(centres_);
    from_ = forces_;
    to_.assign(fresh.begin(), fresh.end());
    gap_ = since_;
    since_ = 0.0;
  }
  VectorX displacement() override { return slow_->displacement(); }
  double own_error() override { return slow_->own_error(); }
  Index nodes() const override { return slow_->nodes(); }

 private:
  std::unique_ptr<Contender> slow_;
  double period_, gap_ = 1.0, since_ = 0.0;  // in ticks
  std::vector<Vector3> centres_, from_, to_, forces_;
};

}  // namespace

void add_plain_eigen(const Bench& bench, std::vector<Entry>& entries) {
  for (const std::string& mesh : meshes_for_node_contact(bench)) {
    Entry entry{baseline(mesh, "Tet4", "linear", "Eigen SimplicialLDLT, solved every tick", 1e-3)};
    entry.make = [&bench, mesh] { return std::make_unique<EveryTick<Ldlt>>(bench, bench.mesh(mesh)); };
    entries.push_back(entry);
    if (mesh != "given" && !bench.full) continue;
    entry.description = baseline(mesh, "Tet4", "linear", "Eigen ConjugateGradient 1e-4, every tick", 0.05);
    entry.make = [&bench, mesh] { return std::make_unique<EveryTick<Gradients>>(bench, bench.mesh(mesh)); };
    entries.push_back(entry);
    entry.description = baseline(mesh, "Tet4", "linear", "Eigen SimplicialLDLT, 30 Hz", 1e-3);
    entry.description.work = "forces interpolated";
    entry.description.own_core = true;
    entry.make = [&bench, mesh] {
      return std::make_unique<Interpolated>(std::make_unique<EveryTick<Ldlt>>(bench, bench.mesh(mesh)), 1.0 / 30.0,
                                            bench.scene.spheres.size());
    };
    entries.push_back(entry);
  }
}

}  // namespace tradeoff
