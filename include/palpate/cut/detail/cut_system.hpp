// The compliance and the displacement of a body while it is cut.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/detail/lanes.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/bordered_update.hpp>
#include <palpate/cut/detail/cut_base.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_plan.hpp>
#include <palpate/cut/detail/cut_step.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/element_changes.hpp>
#include <palpate/cut/detail/kept_dofs.hpp>
#include <palpate/cut/detail/matrix_pool.hpp>
#include <palpate/cut/detail/topology_change.hpp>
#include <palpate/linear/detail/front_reduction.hpp>
#include <palpate/linear/detail/tile.hpp>

#include <algorithm>
#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A linear body under cuts. The compliance among kept dofs is updated exactly (bordered_update.hpp), by the rows that
/// a cut changes; the factor is not changed. Nodes touched by a cut become kept: their columns come from the factor,
/// corrected for the earlier cuts. A cut among kept nodes needs no solve.
///
/// Parts that a cut leaves unsupported keep their place in the matrices and are attached to springs, without effect on
/// the rest. So no system is singular: dofs of detached fragments have displacements, but these are meaningless.
template <Element E>
class CutSystem {
 public:
  /// `physics` must outlive it. Enters stages, memory and accuracy into a report. Throws as CutBase.
  CutSystem(const CutTopology<E>& topology, const CutPhysics<E>& physics, const std::vector<NodeId>& kept_nodes,
            const SetupLimits& limits = {}, SetupReport* report = nullptr)
      : physics_(&physics), base_(topology, physics, kept_nodes, limits, report) {
    compliance_ = base_.compliance();
    for (const NodeDof& dof : base_.kept()) dofs_.add(dof);
    source_.resize(topology.mesh().positions.size());
    std::iota(source_.begin(), source_.end(), NodeId{0});
    displacement_ = base_.displacement();
    none_ = static_cast<Index>(base_.kept().size());
    constexpr int spare = 3;  // one to write, and those used by the tick and by the buffer in between
    limits.require_memory(MatrixPool::bytes(none_, spare), "storage for the compliances of cuts");
    pool_.prepare(none_, spare);
    if (report == nullptr) return;
    report->solver_bytes = base_.bytes();
    report->compliance_bytes = static_cast<std::size_t>(MatrixPool::bytes(none_, spare));
  }

  /// Applies a cut and returns the step that is read from now on, until `fold`. Strong guarantee. Throws
  /// not_positive_definite when rounding leaves no accurate result (make a new system of the topology), bad_argument
  /// when the last step was not folded. Cost: solves for changed nodes that were not kept, and O(kept x changed).
  std::shared_ptr<const CutStep> update(const CutTopology<E>& topology, const TopologyChange<E>& change) {
    if (step_) raise(SetupErrorKind::bad_argument, "the last cut is not folded in");
    const CutPlan<E> plan(topology, change, *physics_, base_, dofs_, displacement_);
    ReducedUnits units;
    const MatrixX columns = columns_of(plan, units);
    auto step = std::make_shared<CutStep>();
    solve_small(plan, columns, *step);
    const typename ElementChanges<E>::Before changes(changes_, change);
    const std::size_t promoted = promoted_.size(), nodes = source_.size();
    const Index kept_before = kept();
    run_or_undo(
        [&] {
          if (units.size() > 0) promoted_.push_back({kept(), std::move(units)});
          accept(topology, plan, *step);
        },
        [&] {  // memory is short
          while (promoted_.size() > promoted) promoted_.pop_back();
          while (source_.size() > nodes) source_.pop_back();
          dofs_.shrink_to(kept_before);
          changes_.restore(changes);
        });
    step_ = step;
    return step;
  }

  /// Adds the last step to the compliance. O(kept^2 x changed).
  void fold() {
    if (!step_) return;
    const auto folded = pool_.take(step_->all);
    const Index old = step_->old, rest = step_->all - old, panel = 64;
    // A panel of the lower half, mirrored while it is in the cache.
    for (Index j = 0; j < old; j += panel) {
      const Index width = std::min(panel, old - j), height = old - j;
      auto below = folded->block(j, j, height, width);
      below = step_->compliance->block(j, j, height, width);
      if (step_->rank() > 0)
        below.noalias() -= step_->z.middleCols(j, height).transpose() * step_->y.middleCols(j, width);
      below.topRows(width).template triangularView<Eigen::StrictlyUpper>() = below.topRows(width).transpose();
      for (Index i = width; i < height; i += panel) {
        const Index rows = std::min(panel, height - i);
        folded->block(j, j + i, width, rows) = below.middleRows(i, rows).transpose();
      }
    }
    folded->block(0, old, step_->all, rest) = step_->extra;
    folded->block(old, 0, rest, old) = step_->extra.topRows(old).transpose();
    compliance_ = folded;
    step_.reset();
  }
  /// A step without changes, for ticks after `fold`. Folded systems only.
  std::shared_ptr<const CutStep> folded_step() const {
    auto step = std::make_shared<CutStep>();
    step->compliance = compliance_;
    step->old = step->all = kept();
    return step;
  }

  /// Index of a dof in the compliance, -1 when it is prescribed or not kept.
  Index index_of(NodeId node, int component) const noexcept { return dofs_.index_of(node, component); }
  Index kept() const noexcept { return dofs_.size(); }
  /// Number of dofs that became kept since the factorisation.
  Index added() const noexcept { return kept() - none_; }
  /// Displacement under the scene's loads, 3 per node [m]: exact at kept nodes of the supported part, elsewhere after
  /// `recover`.
  const VectorX& displacement() const noexcept { return displacement_; }
  const CutBase<E>& base() const noexcept { return base_; }

  /// Computes the displacement of all nodes under the scene's loads. Two substitutions.
  void recover() { recover_into({}, displacement_, displacement_); }

  /// Displacement with forces on kept nodes, 3 per node [m]. Folds first. O(kept x forces) and two substitutions.
  template <class Forces>
  VectorX displacement_with(const Forces& forces) {
    fold();
    VectorX u = displacement_;
    for (const auto& [node, force] : forces)
      for (int c = 0; c < 3; ++c)
        if (const Index j = index_of(node, c); j >= 0)
          for (Index i = 0; i < kept(); ++i) dofs_.at(u, i) += (*compliance_)(i, j) * force[c];
    std::vector<std::pair<NodeId, Vector3>> list;
    for (const auto& [node, force] : forces) list.push_back({node, force});
    recover_into(list, u, u);
    return u;
  }

  /// Measured relative error of the folded compliance: applies a load to all kept dofs and compares the displacement
  /// with that of the factor under this load plus the forces of the cuts. One solve.
  double measured_error() {
    fold();
    const Index n = kept();
    if (n == 0) return 0.0;
    MatrixX load(n, 1);
    for (Index i = 0; i < n; ++i) load(i, 0) = std::sin(1.0 + 3.7 * static_cast<double>(i));
    const MatrixX x = compliance_->topLeftCorner(n, n) * load;
    MatrixX rest = load;
    changes_.subtract_product(x, rest, places());
    VectorX b = VectorX::Zero(base_.size()), answer;
    double wrong = 0.0, border = 0.0;
    for (Index i = 0; i < n; ++i)
      if (const Index p = base_place(i); p >= 0)
        b[p] = rest(i, 0);
      else
        border = std::max(border, std::abs(rest(i, 0)));
    base_.solve(b, answer);
    for (Index i = 0; i < n; ++i)
      if (const Index p = base_place(i); p >= 0) wrong = std::max(wrong, std::abs(answer[p] - x(i, 0)));
    return std::max(wrong / x.cwiseAbs().maxCoeff(), border);
  }

 private:
  auto places() const {
    return [this](NodeId node, int c) { return index_of(node, c); };
  }
  Index base_place(Index i) const noexcept { return base_.index_of(dofs_[i].node, dofs_[i].component); }

  /// Columns of the current inverse for the promoted dofs, over kept and promoted rows. `units` stores the data that
  /// later promoted dofs need.
  MatrixX columns_of(const CutPlan<E>& plan, ReducedUnits& units) const {
    const Index n = kept(), m = static_cast<Index>(plan.promoted.size());
    MatrixX x = MatrixX::Zero(n + m, m);
    if (m == 0) return x;
    std::vector<Index> dofs;
    for (const NodeDof& d : plan.promoted) dofs.push_back(base_.index_of(d.node, d.component));
    units = base_.interior().reduce_units(dofs);
    const Index core = none_;
    if (m > 16)
      x.topRows(core).noalias() = *base_.compliance() * units.kept_load;
    else  // one pass over a symmetric matrix; a general product would first copy all of it
      for (Index j = 0; j < core; ++j) x.row(j).noalias() = base_.compliance()->col(j).transpose() * units.kept_load;
    const MatrixX onto = x.topRows(core);
    for (const auto& [first, before] : promoted_)
      x.middleRows(first, before.size()) = before.products(units) + before.kept_load.transpose() * onto;
    x.bottomRows(m) = units.products(units) + units.kept_load.transpose() * onto;
    apply_changes(x);
    return x;
  }
  /// Converts columns of the factor's inverse to columns of the current one: x + C r, r = - (stiffness change) x.
  void apply_changes(MatrixX& x) const {
    if (changes_.empty()) return;
    const Index n = kept(), m = x.cols();
    MatrixX r = MatrixX::Zero(n, m);
    const MatrixX old = x.topRows(n);
    changes_.subtract_product(old, r, places());
    const std::vector<Index> rows = changes_.indices(places());
    MatrixX part(n, static_cast<Index>(rows.size())), force(static_cast<Index>(rows.size()), m);
    for (std::size_t k = 0; k < rows.size(); ++k) {
      part.col(static_cast<Index>(k)) = compliance_->col(rows[k]).head(n);
      force.row(static_cast<Index>(k)) = r.row(rows[k]);
    }
    x.topRows(n).noalias() += part * force;
    x.bottomRows(m).noalias() += x.topRows(n).transpose() * r;
    x.bottomRows(m) = (0.5 * (x.bottomRows(m) + x.bottomRows(m).transpose())).eval();
  }

  /// Assembles the change over changed and fresh dofs, solves, and writes the step.
  void solve_small(const CutPlan<E>& plan, const MatrixX& columns, CutStep& step) const {
    const Index n = kept(), m = columns.cols(), old = n + m, fresh = static_cast<Index>(plan.fresh.size());
    const Index s = static_cast<Index>(plan.changed.size());
    const MatrixX all = plan.assemble();
    MatrixX z(s, old);
    for (Index k = 0; k < s; ++k) {
      const Index p = plan.changed[static_cast<std::size_t>(k)];
      if (p >= n)
        z.row(k) = columns.col(p - n).transpose();
      else
        z.row(k) << compliance_->col(p).head(n).transpose(), columns.row(p);
    }
    MatrixX h(s, s);
    for (Index k = 0; k < s; ++k) h.col(k) = z.col(plan.changed[static_cast<std::size_t>(k)]);
    const BorderedUpdate u(h, all.topLeftCorner(s, s), all.topRightCorner(s, fresh),
                           all.bottomRightCorner(fresh, fresh));
    const MatrixX y = u.q * z;
    step.compliance = compliance_;
    step.old = n;
    step.all = old + fresh;
    step.smallest = u.smallest;
    step.extra.resize(step.all, m + fresh);
    step.extra.topLeftCorner(old, m) = columns - z.transpose() * y.rightCols(m);
    const MatrixX onto = z - h * y;  // rows of the new inverse at changed dofs
    step.extra.topRightCorner(old, fresh) = onto.transpose() * u.r.transpose();
    step.extra.bottomLeftCorner(fresh, m) = u.r * onto.rightCols(m);
    MatrixX at_changed(s, s);
    for (Index k = 0; k < s; ++k) at_changed.col(k) = onto.col(plan.changed[static_cast<std::size_t>(k)]);
    step.extra.bottomRightCorner(fresh, fresh) = u.border_inverse + u.r * at_changed * u.r.transpose();
    step.z = z.leftCols(n);
    step.y = y.leftCols(n);
  }

  /// Only a lack of memory can throw; the displacement is then unchanged.
  void accept(const CutTopology<E>& topology, const CutPlan<E>& plan, const CutStep& step) {
    VectorX displacement = VectorX::Zero(3 * topology.mesh().node_count());
    displacement.head(displacement_.size()) = displacement_;
    for (const NodeCopy& copy : plan.change->copies) source_.push_back(source_[static_cast<std::size_t>(copy.parent)]);
    for (const NodeCopy& copy : plan.change->copies)
      displacement.template segment<3>(3 * Index{copy.node}) = displacement.template segment<3>(3 * Index{copy.parent});
    for (const auto* list : {&plan.promoted, &plan.fresh})
      for (const NodeDof& d : *list) dofs_.add(d);
    for (const ChangedElement<E>& x : plan.change->elements) changes_.add(x, topology.part(x.element), *physics_);
    for (const auto& pin : plan.pins) changes_.add(pin);
    move(step, displacement);
    displacement_.swap(displacement);
  }
  /// Displacement of kept nodes: from the rest state of the factor and the forces that all cuts since have released. It
  /// does not start from the state before this cut, so errors do not accumulate.
  void move(const CutStep& step, VectorX& displacement) const {
    VectorX force = VectorX::Zero(kept());
    changes_.add_forces([&](NodeId node) { return rest_of(node); },
                        [&](NodeId node, const Vector3& f) {
                          for (int c = 0; c < 3; ++c)
                            if (const Index p = index_of(node, c); p >= 0) force[p] += f[c];
                        });
    const Index old = step.old, rest = step.all - old;
    VectorX u(step.all);
    const VectorX head = force.head(old);
    u.head(old).setZero();
    for (Index j = 0; j < old; ++j)
      if (head[j] != 0.0) u.head(old) += head[j] * step.compliance->col(j).head(old);
    u.head(old).noalias() -= step.z.transpose() * VectorX(step.y * head);
    u.head(old).noalias() += step.extra.topRows(old) * force.tail(rest);
    u.tail(rest).noalias() =
        step.extra.topRows(old).transpose() * head + step.extra.bottomRows(rest) * force.tail(rest);
    for (Index i = 0; i < step.all; ++i) {
      const NodeDof& d = dofs_[i];
      dofs_.at(displacement, i) = rest_of(d.node)[d.component] + u[i];
    }
  }
  /// Displacement, in the factor, of the node from which a node was copied.
  Vector3 rest_of(NodeId node) const noexcept {
    return base_.displacement().template segment<3>(3 * Index{source_[static_cast<std::size_t>(node)]});
  }

  /// All nodes of the factor from the displacement of kept nodes; `forces` on nodes are added to the loads of the
  /// factor.
  void recover_into(const std::vector<std::pair<NodeId, Vector3>>& forces, const VectorX& known, VectorX& u) {
    if (base_.size() == 0) return;
    VectorX load = VectorX::Zero(base_.size()), answer(base_.size());
    const auto add = [&](NodeId node, const Vector3& f) {
      for (int c = 0; c < 3; ++c)
        if (const Index p = base_.index_of(node, c); p >= 0) load[p] += f[c];
    };
    changes_.add_forces([&](NodeId node) { return Vector3(known.template segment<3>(3 * Index{node})); }, add);
    for (const auto& [node, f] : forces) add(node, f);
    const Index core = static_cast<Index>(base_.kept().size());
    VectorX scratch(core), moved(core);
    for (Index i = 0; i < core; ++i) moved[i] = dofs_.at(known, i) - dofs_.at(base_.displacement(), i);
    base_.interior().eliminate_into(load, scratch);
    base_.interior().recover_into(moved, answer);
    const VectorX& rest = base_.displacement();
    for (Index dof = 0; dof < rest.size(); ++dof) {
      const auto node = static_cast<NodeId>(dof / 3);
      const int c = static_cast<int>(dof % 3);
      if (index_of(node, c) < 0)
        if (const Index p = base_.index_of(node, c); p >= 0) u[dof] = rest[dof] + answer[p];
    }
  }

  const CutPhysics<E>* physics_;
  CutBase<E> base_;
  std::shared_ptr<const MatrixX> compliance_;  // among the first kept() dofs when there is no step
  std::shared_ptr<const CutStep> step_;
  MatrixPool pool_;
  KeptDofs dofs_;
  std::vector<NodeId> source_;                            // per node, the node of the factor from which it was copied
  Index none_ = 0;                                        // number of dofs kept by the factor
  std::vector<std::pair<Index, ReducedUnits>> promoted_;  // by the index of the first dof
  VectorX displacement_;
  ElementChanges<E> changes_;
};

}}}  // namespace palpate::detail
