// The part of a sparse Cholesky factorisation that depends on the pattern of the matrix only.
#pragma once

#include <palpate/core/content_hash.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/linear/front_tree_builder.hpp>
#include <palpate/linear/nested_dissection.hpp>

#include <memory>

namespace palpate { inline namespace PALPATE_ABI {

/// Elimination order, fronts and memory of a factorisation, for any values on one pattern. Copies share everything.
class CholeskyAnalysis {
 public:
  CholeskyAnalysis() = default;

  /// Analyses the pattern of the lower half of a matrix. O(nonzeros + nodes log nodes), a few per cent of the
  /// factorisation. Throws bad_argument when the layout does not fit, or cancelled.
  explicit CholeskyAnalysis(const SparseLower& lower, const DofLayout& layout = {}, const SetupLimits& limits = {}) {
    limits.advance("factorisation", 0.0);
    const NodeGraph graph = node_graph(lower, layout);
    const detail::EliminationTree tree = detail::elimination_tree(graph, nested_dissection(graph));
    const detail::Supernodes supernodes = detail::SupernodeBuilder(graph, tree).build();
    auto made = std::make_shared<Data>();
    made->tree = detail::FrontTreeBuilder(graph, supernodes, lower).take();
    made->kept = layout.kept;
    made->node_of_dof = layout.node_of_dof;
    made->pattern = hash_of_pattern(lower);
    data_ = std::move(made);
  }

  Index size() const noexcept { return data_ ? data_->tree.place_of_dof.size() : 0; }
  /// Dofs eliminated last, as given in the layout.
  const std::vector<Index>& kept() const noexcept {
    static const std::vector<Index> none;
    return data_ ? data_->kept : none;
  }
  /// Per dof the node it belongs to, as given in the layout; may be empty.
  const std::vector<Index>& node_of_dof() const noexcept { return data_->node_of_dof; }
  Index front_count() const noexcept { return data_ ? data_->tree.fronts.size() : 0; }
  /// Stored entries of L, zeros from merging included.
  double nonzeros() const noexcept { return data_ ? data_->tree.nonzeros : 0.0; }
  /// Multiplications and additions of a factorisation: sum of squares of the column lengths of L.
  double flops() const noexcept { return data_ ? data_->tree.flops : 0.0; }
  /// What a finished factor holds [bytes].
  double factor_bytes() const noexcept {
    return data_ ? sizeof(double) * static_cast<double>(data_->tree.factor_size) : 0.0;
  }
  /// Largest memory held during a factorisation, the factor included [bytes].
  double peak_bytes() const noexcept {
    if (!data_) return 0.0;
    return factor_bytes() + sizeof(double) * static_cast<double>(data_->tree.workspace_size + side_size());
  }
  /// The same when the last front is handed out as a Schur complement, that included [bytes].
  double interior_peak_bytes() const noexcept {
    if (!data_ || data_->kept.empty()) return peak_bytes();
    const auto k = static_cast<Index>(data_->kept.size());
    const Index last = std::max(data_->tree.workspace_size, k * k);
    return factor_bytes() + sizeof(double) * static_cast<double>(last + side_size());
  }
  /// True when the matrix has the pattern that was analysed.
  bool fits(const SparseLower& lower) const noexcept { return data_ && data_->pattern == hash_of_pattern(lower); }

  /// Hash of the elimination order and of where everything lies in a factor: a stored factor belongs to an analysis
  /// that has the same. The order follows from positions in floating point, so another build may find another one.
  std::uint64_t order_hash() const noexcept {
    ContentHash hash;
    if (!data_) return hash.digest();
    const detail::FrontTree& t = data_->tree;
    hash.add(detail::LowerPanels::width);
    hash.add(detail::LowerPanels::alignment);
    hash.add(std::span<const detail::Front>(t.fronts.data(), static_cast<std::size_t>(t.fronts.size())));
    hash.add(std::span<const detail::Run>(t.runs.data(), static_cast<std::size_t>(t.runs.size())));
    hash.add(std::span<const NodeId>(t.place_of_dof.data(), static_cast<std::size_t>(t.place_of_dof.size())));
    hash.add(std::span<const Index>(data_->kept));
    return hash.digest();
  }

  const detail::FrontTree& tree() const noexcept { return data_->tree; }
  /// Doubles that a factorisation needs to pack operands; zero rows at the end included.
  Index pack_size() const noexcept { return 2 * (data_->tree.largest_front + 64) * detail::LowerPanels::width; }

 private:
  Index side_size() const noexcept { return pack_size() + 3 * size(); }

  struct Data {
    detail::FrontTree tree;
    std::vector<Index> kept, node_of_dof;
    std::uint64_t pattern = 0;
  };

  static std::uint64_t hash_of_pattern(const SparseLower& m) noexcept {
    ContentHash hash;
    hash.add(std::span<const Index>(m.outerIndexPtr(), static_cast<std::size_t>(m.cols()) + 1));
    hash.add(std::span<const Index>(m.innerIndexPtr(), static_cast<std::size_t>(m.outerIndexPtr()[m.cols()])));
    return hash.digest();
  }

  std::shared_ptr<const Data> data_;
};

}}  // namespace palpate
