// Definitions of cholesky_analysis.hpp.
#pragma once

#include <palpate/core/detail/content_hash.hpp>
#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/front_tree_builder.hpp>
#include <palpate/linear/detail/lower_panels.hpp>
#include <palpate/linear/detail/nested_dissection.hpp>
#include <palpate/linear/detail/parallel_fronts.hpp>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

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

}  // namespace detail

struct CholeskyAnalysis::Data {
  detail::FrontTree tree;
  std::vector<Index> kept, node_of_dof;
  std::uint64_t pattern = 0;
};

PALPATE_INLINE CholeskyAnalysis::CholeskyAnalysis(const SparseLower& lower, const DofLayout& layout,
                                                  const SetupLimits& limits) {
  limits.advance("factorisation", 0.0);
  const NodeGraph graph = node_graph(lower, layout);
  const detail::EliminationTree tree = detail::elimination_tree(graph, nested_dissection(graph, limits));
  auto made = std::make_shared<Data>();
  made->tree = detail::build_front_tree(graph, detail::find_supernodes(graph, tree), lower);
  made->kept = layout.kept;
  made->node_of_dof = layout.node_of_dof;
  made->pattern = detail::hash_of_pattern(lower);
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
  const double side = detail::ParallelFronts::peak_doubles(data_->tree, front_count(), pack_size(), threads);
  return factor_bytes() + sizeof(double) * (side + 2.0 * static_cast<double>(size()));
}
PALPATE_INLINE double CholeskyAnalysis::interior_peak_bytes(int threads) const {
  if (!data_ || data_->kept.empty()) return peak_bytes(threads);
  const auto k = static_cast<double>(data_->kept.size());
  const double side = detail::ParallelFronts::peak_doubles(data_->tree, front_count() - 1, pack_size(), threads);
  return factor_bytes() + sizeof(double) * (std::max(side, k * k) + 2.0 * static_cast<double>(size()));
}
PALPATE_INLINE bool CholeskyAnalysis::fits(const SparseLower& lower) const noexcept {
  return data_ && data_->pattern == detail::hash_of_pattern(lower);
}

PALPATE_INLINE std::uint64_t CholeskyAnalysis::order_hash() const noexcept {
  ContentHash hash;
  if (!data_) return hash.digest();
  const detail::FrontTree& t = data_->tree;
  hash.add(detail::LowerPanels::width);
  hash.add(detail::LowerPanels::alignment);
  detail::add_to_hash(hash, t.fronts);
  detail::add_to_hash(hash, t.runs);
  detail::add_to_hash(hash, t.place_of_dof);
  hash.add(std::span<const Index>(data_->kept));
  return hash.digest();
}

PALPATE_INLINE const detail::FrontTree& CholeskyAnalysis::tree() const noexcept {
  return data_->tree;
}
PALPATE_INLINE Index CholeskyAnalysis::pack_size() const noexcept {
  return 2 * (data_->tree.largest_front + 64) * detail::LowerPanels::width;
}
}}  // namespace palpate
