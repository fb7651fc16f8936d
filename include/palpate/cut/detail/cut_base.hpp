// The factor from which cuts are subtracted.
#pragma once

#include <palpate/assembly/assembled.hpp>
#include <palpate/assembly/block_matrix.hpp>
#include <palpate/assembly/body.hpp>
#include <palpate/assembly/essential_conditions.hpp>
#include <palpate/assembly/free_stiffness.hpp>
#include <palpate/assembly/detail/smoothed_stiffness.hpp>
#include <palpate/concepts/element.hpp>
#include <palpate/condensation/detail/schur.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/fragments.hpp>
#include <palpate/cut/detail/kept_dofs.hpp>
#include <palpate/linear/condition.hpp>
#include <palpate/linear/detail/node_graph.hpp>
#include <palpate/linear/detail/spd_inverse.hpp>
#include <palpate/linear/detail/tile.hpp>
#include <palpate/linear/sparse_cholesky.hpp>
#include <palpate/model/detail/stage_timer.hpp>
#include <palpate/model/setup_report.hpp>
#include <palpate/model/static/detail/prepared_system.hpp>

#include <memory>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Stiffness of the supported part of a topology, factorised with some nodes kept, and the compliance among these.
template <Element E>
class CutBase {
 public:
  /// `kept_nodes` that are not in the supported part are left out, and so are prescribed components. Throws as
  /// assembly, factorisation and loads. Costs a factorisation, the inverse of the kept part and two substitutions. With
  /// a report measures the accuracy, too, and throws ill_conditioned as the set-up of a static model.
  CutBase(const CutTopology<E>& topology, const CutPhysics<E>& physics, const std::vector<NodeId>& kept_nodes,
          const SetupLimits& limits = {}, SetupReport* report = nullptr) {
    SetupReport unused;
    SetupReport& entries = report != nullptr ? *report : unused;
    std::vector<NodeId> node_map;
    std::vector<Index> element_map;
    Body<E> supported{topology.extract(ElementState::supported, node_map, element_map),
                      physics.body.elasticity,
                      physics.body.density,
                      physics.body.initial_strain,
                      {}};
    if (!physics.body.materials.empty())
      for (const Index e : element_map)
        supported.materials.push_back(physics.body.materials[static_cast<std::size_t>(topology.origin_of_element(e))]);
    const EssentialConditions conditions =
        constrained_conditions(topology, physics, node_map, supported.mesh.node_count());
    place_.assign(3 * node_map.size(), -1);
    for (std::size_t i = 0; i < place_.size(); ++i)
      if (const NodeId node = node_map[i / 3]; node >= 0)
        place_[i] = conditions.free_index[static_cast<std::size_t>(3 * Index{node}) + i % 3];
    DofLayout layout{{}, supported.mesh.positions, {}};
    for (const NodeId node : kept_nodes)
      for (int c = 0; c < 3; ++c)
        if (index_of(node, c) >= 0) {
          layout.kept.push_back(index_of(node, c));
          kept_.push_back({node, c});
        }
    for (const Index dof : conditions.free_dofs) layout.node_of_dof.push_back(dof / 3);
    size_ = conditions.free_count();
    VectorX load = VectorX::Zero(size_);
    if (size_ > 0) {
      const BlockMatrix k = [&] {
        const StageTimer timer(entries, "assembly");
        return assemble_stiffness<E>(supported, limits);
      }();
      entries.stiffness_bytes = k.bytes();
      make_factor(k, conditions, layout, limits, entries);
      load = free_load(topology, physics, k, conditions, node_map);
      if (report != nullptr) check_accuracy(k, conditions, limits, *report);
    } else {
      compliance_ = std::make_shared<const MatrixX>();
    }
    solve_statics(topology, physics, load);
  }

  Index size() const noexcept { return size_; }
  /// Of factor and compliance.
  std::size_t bytes() const noexcept {
    return interior_.bytes() + static_cast<std::size_t>(compliance_->size()) * sizeof(double);
  }
  /// Free dofs of the kept nodes, in the order of the compliance.
  const std::vector<NodeDof>& kept() const noexcept { return kept_; }
  const std::shared_ptr<const MatrixX>& compliance() const noexcept { return compliance_; }
  SparseCholesky& interior() noexcept { return interior_; }
  const SparseCholesky& interior() const noexcept { return interior_; }
  /// Index of a dof in the factor; -1 when it is prescribed, not supported, or newer than the factor.
  Index index_of(NodeId node, int component) const noexcept {
    const auto i = static_cast<std::size_t>(3 * Index{node} + component);
    return i < place_.size() ? place_[i] : -1;
  }
  /// Displacement under the scene's loads before any later cut, 3 per node [m].
  const VectorX& displacement() const noexcept { return displacement_; }

  /// x = K^-1 b. Allocates on first use only.
  void solve(const VectorX& b, VectorX& x) {
    kept_load_.resize(static_cast<Index>(kept_.size()));
    x.resize(size_);
    if (size_ == 0) return;
    interior_.eliminate_into(b, kept_load_);
    interior_.recover_into(*compliance_ * kept_load_, x);
  }

 private:
  /// The base as a LinearSolver.
  struct Solver {
    CutBase& base;
    Index size() const noexcept { return base.size(); }
    SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
      base.solve(b, x);
      return {true, 0, 0.0};
    }
  };

  void make_factor(const BlockMatrix& k, const EssentialConditions& conditions, const DofLayout& layout,
                   const SetupLimits& limits, SetupReport& entries) {
    SchurComplement schur = [&] {
      const StageTimer timer(entries, "factorisation");
      return condense(free_matrix(k, conditions), layout, limits);
    }();
    const StageTimer timer(entries, "compliance");
    limits.advance("compliance", 0.0);
    if (schur.stiffness.rows() > 0)
      SpdInverse::invert(schur.stiffness, 1e-15, "the condensed stiffness is not positive definite", limits.threads);
    limits.advance("compliance", 0.5);
    interior_ = std::move(schur.interior);
    compliance_ = std::make_shared<const MatrixX>(std::move(schur.stiffness));
  }
  void check_accuracy(const BlockMatrix& k, const EssentialConditions& conditions, const SetupLimits& limits,
                      SetupReport& report) {
    const StageTimer timer(report, "checks");
    limits.advance("checks", 0.0);
    Solver solver{*this};
    report.probe_error = probe_error(FreeStiffness(k, conditions), solver);
    limits.advance("checks", 0.5);
    report.condition_estimate = free_norm(k, conditions) * inverse_norm_estimate(solver);
    judge_accuracy(false, report);
  }
  static EssentialConditions constrained_conditions(const CutTopology<E>& topology, const CutPhysics<E>& physics,
                                                    const std::vector<NodeId>& node_map, Index count) {
    EssentialConditions c;
    c.constrained.assign(static_cast<std::size_t>(count), 0);
    c.prescribed = VectorX::Zero(3 * count);
    c.free_index.assign(static_cast<std::size_t>(3 * count), -1);
    for (std::size_t i = 0; i < node_map.size(); ++i) {
      if (node_map[i] < 0) continue;
      c.constrained[static_cast<std::size_t>(node_map[i])] = topology.constrained()[i];
      c.prescribed.template segment<3>(3 * Index{node_map[i]}) =
          physics.prescribed.template segment<3>(3 * Index{topology.origin_of(static_cast<NodeId>(i))});
    }
    for (Index dof = 0; dof < 3 * count; ++dof)
      if ((c.constrained[static_cast<std::size_t>(dof / 3)] & (1u << (dof % 3))) == 0) {
        c.free_index[static_cast<std::size_t>(dof)] = static_cast<Index>(c.free_dofs.size());
        c.free_dofs.push_back(dof);
      }
    return c;
  }

  VectorX free_load(const CutTopology<E>& topology, const CutPhysics<E>& physics, const BlockMatrix& k,
                    const EssentialConditions& conditions, const std::vector<NodeId>& node_map) const {
    VectorX full(conditions.prescribed.size()), load(size_);
    k.apply(conditions.prescribed, full);
    full = -full;
    for (Index e = 0; e < topology.mesh().element_count(); ++e) {
      if (topology.state(e) != ElementState::supported) continue;
      const auto own = physics.load_of(topology.part(e));
      for (int a = 0; a < E::nodes; ++a)
        full.template segment<3>(3 * Index{node_map[static_cast<std::size_t>(topology.mesh().element_node(e, a))]}) +=
            own.template segment<3>(3 * a);
    }
    for (Index i = 0; 3 * i < physics.nodal_load.size(); ++i)
      if (const NodeId node = node_map[static_cast<std::size_t>(i)]; node >= 0)
        full.template segment<3>(3 * Index{node}) += physics.nodal_load.template segment<3>(3 * i);
    conditions.gather(full, load);
    return load;
  }

  void solve_statics(const CutTopology<E>& topology, const CutPhysics<E>& physics, const VectorX& load) {
    displacement_ = VectorX::Zero(static_cast<Index>(place_.size()));
    VectorX answer(size_);
    solve(load, answer);
    for (std::size_t i = 0; i < place_.size(); ++i) {
      const Index origin = 3 * Index{topology.origin_of(static_cast<NodeId>(i / 3))} + static_cast<Index>(i % 3);
      displacement_[static_cast<Index>(i)] = place_[i] >= 0 ? answer[place_[i]] : physics.prescribed[origin];
    }
    if (!all_finite(displacement_)) raise(SetupErrorKind::non_finite, "the static displacement is not finite");
  }

  Index size_ = 0;
  std::vector<Index> place_;
  std::vector<NodeDof> kept_;
  SparseCholesky interior_;
  std::shared_ptr<const MatrixX> compliance_;
  VectorX displacement_, kept_load_;
};

}}}  // namespace palpate::detail
