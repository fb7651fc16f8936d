// Vertices that a tick asks for, for the thread that prepares the next one.
#pragma once

#include <palpate/core/config.hpp>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Removes those of the first `count` items for which `is_gone` is true.
template <class Items, class IsGone>
void drop_items(Items& items, std::size_t& count, const IsGone& is_gone) noexcept {
  const auto end = items.begin() + static_cast<std::ptrdiff_t>(count);
  count = static_cast<std::size_t>(std::remove_if(items.begin(), end, is_gone) - items.begin());
}

/// A list in which every vertex is once, in the order of the requests. Only the constructor allocates.
class RequestedVertices {
 public:
  RequestedVertices() = default;
  /// For a surface of `vertices`, at most `most` of them.
  RequestedVertices(std::size_t vertices, std::size_t most)
      : most_(std::min(vertices, most)), round_of_(vertices, 0), listed_(most_) {}

  void add(int v) noexcept {
    std::uint64_t& round = round_of_[static_cast<std::size_t>(v)];
    if (round == round_ || count_ == most_) return;
    round = round_;
    listed_[count_++] = v;
  }
  void clear() noexcept {
    count_ = 0;
    ++round_;
  }
  std::span<const int> all() const noexcept { return {listed_.data(), count_}; }

 private:
  std::size_t most_ = 0, count_ = 0;
  std::uint64_t round_ = 1;
  std::vector<std::uint64_t> round_of_;  // in which a vertex was added last
  std::vector<int> listed_;              // the first count_
};

/// A copy of such a list, in room that is allocated once.
class VertexCopy {
 public:
  VertexCopy() = default;
  explicit VertexCopy(std::size_t most) : item_(most) {}
  void copy(std::span<const int> vertices) noexcept {
    count_ = std::min(vertices.size(), item_.size());
    std::copy_n(vertices.begin(), count_, item_.begin());
  }
  template <class IsGone>
  void drop_if(const IsGone& is_gone) noexcept {
    drop_items(item_, count_, is_gone);
  }
  std::span<const int> all() const noexcept { return {item_.data(), count_}; }

 private:
  std::vector<int> item_;  // the first count_
  std::size_t count_ = 0;
};

}}}  // namespace palpate::detail
