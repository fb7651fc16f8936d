// A std::vector indexed by Index, and index types for graphs.
#pragma once

#include <palpate/core/types.hpp>

#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// std::vector with a signed subscript, so that offsets and counts need no casts.
template <class T>
class IndexedVector {
 public:
  IndexedVector() = default;
  explicit IndexedVector(Index size, const T& value = T()) : data_(static_cast<std::size_t>(size), value) {}

  T& operator[](Index i) noexcept { return data_[static_cast<std::size_t>(i)]; }
  const T& operator[](Index i) const noexcept { return data_[static_cast<std::size_t>(i)]; }
  Index size() const noexcept { return static_cast<Index>(data_.size()); }
  bool empty() const noexcept { return data_.empty(); }
  T* data() noexcept { return data_.data(); }
  const T* data() const noexcept { return data_.data(); }
  auto begin() noexcept { return data_.begin(); }
  auto begin() const noexcept { return data_.begin(); }
  auto end() noexcept { return data_.end(); }
  auto end() const noexcept { return data_.end(); }
  T& back() noexcept { return data_.back(); }
  const T& back() const noexcept { return data_.back(); }
  void push_back(const T& value) { data_.push_back(value); }
  void pop_back() noexcept { data_.pop_back(); }
  void clear() noexcept { data_.clear(); }
  void reserve(Index size) { data_.reserve(static_cast<std::size_t>(size)); }
  void assign(Index size, const T& value) { data_.assign(static_cast<std::size_t>(size), value); }
  void resize(Index size) { data_.resize(static_cast<std::size_t>(size)); }
  std::size_t bytes() const noexcept { return data_.size() * sizeof(T); }

 private:
  std::vector<T> data_;
};

using NodeVector = IndexedVector<NodeId>;
using OffsetVector = IndexedVector<Index>;

/// Converts counts, stored one place to the right, into offsets.
inline void accumulate_offsets(OffsetVector& start) noexcept {
  for (Index i = 1; i < start.size(); ++i) start[i] += start[i - 1];
}

}}}  // namespace palpate::detail
