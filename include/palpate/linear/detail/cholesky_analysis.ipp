// Definitions of cholesky_analysis.hpp.
#pragma once

#include <palpate/core/detail/content_hash.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/front_tasks.hpp>
#include <palpate/linear/detail/front_tree.hpp>
#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/nested_dissection.hpp>
#include <palpate/linear/detail/parallel_fronts.hpp>
#include <palpate/linear/detail/supernodes.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Builds the fronts of the supernodes and places the entries of a matrix in them.
FrontTree build_front_tree(const NodeGraph& g, const Supernodes& s, const SparseLower& lower);

/// Builds a FrontTree from supernodes.
class FrontTreeBuilder {
 public:
  FrontTreeBuilder(const NodeGraph& g, const Supernodes& s, const SparseLower& lower) : g_(g), s_(s), lower_(lower) {
    number();
    rows();
    distribute_entries();
    place_updates();
  }
  FrontTree take() { return std::move(tree_); }

 private:
  void number() {
    const Index count = s_.pivots.size(), nodes = g_.nodes();
    position_.resize(nodes);
    front_of_position_.resize(nodes);
    place_.assign(nodes + 1, 0);
    tree_.fronts.resize(count);
    tree_.place_of_dof.resize(g_.dof.size());
    tree_.front_of_dof.resize(g_.dof.size());
    for (Index f = 0; f < count; ++f) {
      tree_.fronts[f].first = place_[s_.start[f]];
      for (Index i = s_.start[f]; i < s_.start[f + 1]; ++i) {
        const NodeId node = s_.order[i];
        position_[node] = static_cast<NodeId>(i);
        front_of_position_[i] = static_cast<NodeId>(f);
        place_[i + 1] = place_[i] + static_cast<NodeId>(g_.weight(node));
        for (Index d = g_.dof_start[node]; d < g_.dof_start[node + 1]; ++d) {
          tree_.place_of_dof[g_.dof[d]] = place_[i] + static_cast<NodeId>(d - g_.dof_start[node]);
          tree_.front_of_dof[g_.dof[d]] = static_cast<NodeId>(f);
        }
      }
    }
    link();
  }

  void link() noexcept {
    for (Index f = tree_.fronts.size() - 1; f >= 0; --f) {
      Front& front = tree_.fronts[f];
      front.pivots = s_.pivots[f];
      front.rows = s_.rows[f];
      front.parent = s_.parent[f];
      if (front.parent < 0) continue;
      front.next_sibling = tree_.fronts[front.parent].first_child;
      tree_.fronts[front.parent].first_child = static_cast<NodeId>(f);
    }
  }

  /// Rows of each front: those of its children and of its own matrix columns, without its pivots.
  void rows() {
    const Index count = tree_.fronts.size();
    NodeVector seen(g_.nodes(), -1), rows;
    OffsetVector start(count + 1, 0);
    for (Index f = 0; f < count; ++f) {
      const Index end = s_.start[f + 1], begin = rows.size();
      const auto add = [&](NodeId i) {
        if (i < end || seen[i] == f) return;
        seen[i] = static_cast<NodeId>(f);
        rows.push_back(i);
      };
      const Front& front = tree_.fronts[f];
      if (front.rows > 0) {
        for (Index i = s_.start[f]; i < end; ++i)
          for (Index p = g_.start[s_.order[i]]; p < g_.start[s_.order[i] + 1]; ++p) add(position_[g_.neighbour[p]]);
        for (NodeId c = front.first_child; c >= 0; c = tree_.fronts[c].next_sibling)
          for (Index p = start[c]; p < start[c + 1]; ++p) add(rows[p]);
        std::sort(rows.begin() + begin, rows.end());
      }
      start[f + 1] = rows.size();
      make_runs(tree_.fronts[f], rows.data() + begin, rows.data() + rows.size());
    }
  }

  void make_runs(Front& front, const NodeId* row, const NodeId* end) {
    front.run_begin = tree_.runs.size();
    for (; row != end; ++row) {
      const NodeId first = place_[*row], count = place_[*row + 1] - first;
      if (tree_.runs.size() > front.run_begin && tree_.runs.back().first + tree_.runs.back().count == first)
        tree_.runs.back().count += count;
      else
        tree_.runs.push_back({first, count});
    }
    front.run_end = tree_.runs.size();
  }

  /// Visits every run of entries of one column that belong to one node.
  template <class Visit>
  void visit_entries(Visit&& visit) const {
    const Index* start = lower_.outerIndexPtr();
    const Index* row = lower_.innerIndexPtr();
    for (Index j = 0; j < lower_.cols(); ++j) {
      const NodeId column = tree_.place_of_dof[j];
      for (Index p = start[j]; p < start[j + 1];) {
        const Index begin = p++;
        if (row[begin] < j) continue;
        const NodeId node = g_.node_of_dof[row[begin]], place = tree_.place_of_dof[row[begin]];
        while (p < start[j + 1] && g_.node_of_dof[row[p]] == node && tree_.place_of_dof[row[p]] == place + (p - begin))
          ++p;
        const auto count = static_cast<NodeId>(p - begin);
        if (place >= column)
          visit(tree_.front_of_dof[j], EntryRun{begin, column, place, count, -1});
        else
          visit(front_of_position_[position_[node]], EntryRun{begin, place, column, static_cast<NodeId>(-count), -1});
      }
    }
  }

  void distribute_entries() {
    tree_.entries.reserve(lower_.outerIndexPtr()[lower_.cols()] / 2);
    visit_entries([&](NodeId f, EntryRun e) {
      e.next = tree_.fronts[f].first_entry;
      tree_.fronts[f].first_entry = static_cast<NodeId>(tree_.entries.size());
      tree_.entries.push_back(e);
    });
  }

  void place_updates() {
    const Index count = tree_.fronts.size();
    IndexedVector<Index> offset(count);
    tree_.workspace_size = stack_updates(tree_.fronts, 0, count, offset);
    for (Index f = 0; f < count; ++f) {
      Front& front = tree_.fronts[f];
      front.update = offset[f];
      front.factor = tree_.factor_size;
      tree_.factor_size += front.panels().size() + Front::padding;
      tree_.largest_front = std::max(tree_.largest_front, front.size());
      tree_.nonzeros += front.nonzeros();
      tree_.flops += front.flops();
    }
  }

  const NodeGraph& g_;
  const Supernodes& s_;
  const SparseLower& lower_;
  FrontTree tree_;
  NodeVector position_, front_of_position_, place_;
};

PALPATE_INLINE FrontTree build_front_tree(const NodeGraph& g, const Supernodes& s, const SparseLower& lower) {
  return FrontTreeBuilder(g, s, lower).take();
}

inline std::uint64_t hash_of_pattern(const SparseLower& m) noexcept {
  ContentHash hash;
  hash.add(std::span<const Index>(m.outerIndexPtr(), static_cast<std::size_t>(m.cols()) + 1));
  hash.add(std::span<const Index>(m.innerIndexPtr(), static_cast<std::size_t>(m.outerIndexPtr()[m.cols()])));
  return hash.digest();
}

template <class T>
void add_to_hash(ContentHash& hash, const IndexedVector<T>& values) noexcept {
  hash.add(std::span<const T>(values.data(), static_cast<std::size_t>(values.size())));
}

struct CholeskyAnalysis::Data {
  FrontTree tree;
  std::vector<Index> kept, node_of_dof;
  std::uint64_t pattern = 0;
};

PALPATE_INLINE CholeskyAnalysis::CholeskyAnalysis(const SparseLower& lower, const DofLayout& layout,
                                                  const SetupLimits& limits) {
  limits.advance("factorisation", 0.0);
  const NodeGraph graph = node_graph(lower, layout);
  const EliminationTree tree = elimination_tree(graph, nested_dissection(graph, limits));
  auto made = std::make_shared<Data>();
  made->tree = build_front_tree(graph, find_supernodes(graph, tree), lower);
  made->kept = layout.kept;
  made->node_of_dof = layout.node_of_dof;
  made->pattern = hash_of_pattern(lower);
  data_ = std::move(made);
}

PALPATE_INLINE Index CholeskyAnalysis::size() const noexcept {
  return data_ ? data_->tree.place_of_dof.size() : 0;
}
PALPATE_INLINE const std::vector<Index>& CholeskyAnalysis::kept() const noexcept {
  static const std::vector<Index> none;
  return data_ ? data_->kept : none;
}
PALPATE_INLINE const std::vector<Index>& CholeskyAnalysis::node_of_dof() const noexcept {
  return data_->node_of_dof;
}
PALPATE_INLINE Index CholeskyAnalysis::front_count() const noexcept {
  return data_ ? data_->tree.fronts.size() : 0;
}
PALPATE_INLINE double CholeskyAnalysis::nonzeros() const noexcept {
  return data_ ? data_->tree.nonzeros : 0.0;
}
PALPATE_INLINE double CholeskyAnalysis::flops() const noexcept {
  return data_ ? data_->tree.flops : 0.0;
}
PALPATE_INLINE double CholeskyAnalysis::factor_bytes() const noexcept {
  return data_ ? sizeof(double) * static_cast<double>(data_->tree.factor_size) : 0.0;
}
PALPATE_INLINE double CholeskyAnalysis::repeated_peak_bytes() const noexcept {
  if (!data_) return 0.0;
  const Index side = data_->tree.workspace_size + pack_size() + 3 * size();
  return factor_bytes() + sizeof(double) * static_cast<double>(side);
}
PALPATE_INLINE double CholeskyAnalysis::peak_bytes(int threads) const {
  if (!data_) return 0.0;
  const double side = ParallelFronts::peak_doubles(data_->tree, front_count(), pack_size(), threads);
  return factor_bytes() + sizeof(double) * (side + 2.0 * static_cast<double>(size()));
}
PALPATE_INLINE double CholeskyAnalysis::interior_peak_bytes(int threads) const {
  if (!data_ || data_->kept.empty()) return peak_bytes(threads);
  const auto k = static_cast<double>(data_->kept.size());
  const double side = ParallelFronts::peak_doubles(data_->tree, front_count() - 1, pack_size(), threads);
  return factor_bytes() + sizeof(double) * (std::max(side, k * k) + 2.0 * static_cast<double>(size()));
}
PALPATE_INLINE bool CholeskyAnalysis::fits(const SparseLower& lower) const noexcept {
  return data_ && data_->pattern == hash_of_pattern(lower);
}

PALPATE_INLINE std::uint64_t CholeskyAnalysis::order_hash() const noexcept {
  ContentHash hash;
  if (!data_) return hash.digest();
  const FrontTree& t = data_->tree;
  hash.add(LowerPanels::width);
  hash.add(LowerPanels::alignment);
  add_to_hash(hash, t.fronts);
  add_to_hash(hash, t.runs);
  add_to_hash(hash, t.place_of_dof);
  hash.add(std::span<const Index>(data_->kept));
  return hash.digest();
}

PALPATE_INLINE const FrontTree& CholeskyAnalysis::tree() const noexcept {
  return data_->tree;
}
PALPATE_INLINE Index CholeskyAnalysis::pack_size() const noexcept {
  return 2 * (data_->tree.largest_front + 64) * LowerPanels::width;
}

}}}  // namespace palpate::detail
