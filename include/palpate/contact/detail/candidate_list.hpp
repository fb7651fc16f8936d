// Contact points, found by tool and sample.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/candidate.hpp>

#include <algorithm>
#include <bit>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Up to `maximum` candidates in an array, with a hash table of their tools and samples (separate chaining). Nothing
/// allocates after construction. `clear` takes O(maximum), everything else constant time on average.
class CandidateList {
 public:
  explicit CandidateList(std::size_t maximum) : items_(maximum), next_(maximum), first_(std::bit_ceil(maximum), -1) {}

  int maximum() const noexcept { return static_cast<int>(items_.size()); }
  int count() const noexcept { return count_; }
  std::span<Candidate> items() noexcept { return {items_.data(), static_cast<std::size_t>(count_)}; }
  std::span<const Candidate> items() const noexcept { return {items_.data(), static_cast<std::size_t>(count_)}; }
  Candidate& operator[](int i) noexcept { return items_[at(i)]; }
  const Candidate& operator[](int i) const noexcept { return items_[at(i)]; }

  void clear() noexcept {
    std::fill(first_.begin(), first_.end(), -1);
    count_ = 0;
  }
  /// The caller guarantees that there is room, and that no other candidate has this tool and sample.
  Candidate& add(const Candidate& c) noexcept { return link(count_++, c); }
  /// Puts a candidate in the place of number i. The same guarantee, but for number i itself.
  Candidate& replace(int i, const Candidate& c) noexcept {
    int* place = &first_[hash(items_[at(i)])];
    while (*place != i) place = &next_[at(*place)];
    *place = next_[at(i)];
    return link(i, c);
  }
  /// The index of the candidate with this tool and sample, -1 if there is none.
  int find(int tool, int sample) const noexcept {
    int i = first_[hash(tool, sample)];
    while (i >= 0 && !(items_[at(i)].sample == sample && items_[at(i)].tool == tool)) i = next_[at(i)];
    return i;
  }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  std::size_t hash(int tool, int sample) const noexcept {
    const std::uint64_t key = static_cast<std::uint64_t>(sample) * maximum_tools + static_cast<std::uint64_t>(tool);
    return (key * 0x9e3779b97f4a7c15u >> 32) & (first_.size() - 1);  // Knuth's multiplicative hash
  }
  std::size_t hash(const Candidate& c) const noexcept { return hash(c.tool, c.sample); }
  Candidate& link(int i, const Candidate& c) noexcept {
    int& first = first_[hash(c)];
    next_[at(i)] = first;
    first = i;
    return items_[at(i)] = c;
  }

  std::vector<Candidate> items_;
  std::vector<int> next_;   // candidate with the same hash, -1 after the last
  std::vector<int> first_;  // per hash
  int count_ = 0;
};

}}  // namespace palpate
