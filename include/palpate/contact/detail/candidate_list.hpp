// Contact points, found by tool and sample.
#pragma once

#include <palpate/contact/contact.hpp>
#include <palpate/contact/detail/contact_samples.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>
#include <bit>
#include <cstdint>
#include <span>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Normals of a row in the last linearisation and the one before: those used, and those that resulted.
struct NormalHistory {
  Vector3 used = Vector3::Zero(), used_before = Vector3::Zero(), made_before = Vector3::Zero();
  int known = 0;  ///< number of consecutive linearisations, at most 2
};

/// A contact point near the sphere of one tool, as of its last evaluation.
struct Candidate {
  int sample = 0;
  int triangle = 0;
  int tool = 0;
  int row = -1;                        ///< of the contact problem, -1 when it has none
  int slot = -1;                       ///< slot of its compliance in the last use
  bool facing = true;                  ///< the sphere is on the outer side
  bool evaluated = true;               ///< false: of gap, point, normal and core only a lower bound of the gap is known
  double gap = 0.0;                    ///< [m]
  double seen = 0.0;                   ///< travel of sphere and surface at the last evaluation [m]
  double force = 0.0;                  ///< of the last solution [N]
  Vector3 point = Vector3::Zero();     ///< on the deformed surface [m]
  Vector3 normal = Vector3::Zero();    ///< unit, from the point to the closest point of the tool's core
  Vector3 core = Vector3::Zero();      ///< that point, in the tool's own frame [m]; zero for a sphere
  Vector3 moved_to = Vector3::Zero();  ///< its place in `generation` of the displacement [m]
  std::uint64_t generation = 0;        ///< 0: not known
  NormalHistory history;

  Vector3 friction = Vector3::Zero();  ///< of the last solution, on the tool [N]
  Vector3 anchor = Vector3::Zero();    ///< stick anchor on the tool after the last tick, tool's own frame [m]
  std::uint64_t stuck_tick = 0;        ///< the tick after which it stuck
  bool grasped = false;                ///< a grasped point, not one found near a sphere
  double area = 0.0;                   ///< of the surface that the point stands for at present [m^2]

  /// Removes its force, friction and history.
  void lift() noexcept {
    force = 0.0;
    stuck_tick = 0;
    history.known = 0;
  }
};

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

/// The candidate of a list with the largest gap, the first one of several: a binary heap (Williams 1964). Nothing
/// allocates after construction.
class FarthestCandidate {
 public:
  explicit FarthestCandidate(std::size_t maximum) : gap_(maximum), heap_(maximum) {}
  bool is_known() const noexcept { return count_ > 0; }
  void forget() noexcept { count_ = 0; }
  /// Collects all candidates from number `first` on, at least one. O(number of candidates).
  void collect(std::span<const Candidate> candidates, int first) noexcept {
    count_ = 0;
    for (std::size_t i = at(first); i < candidates.size(); ++i) {
      gap_[i] = candidates[i].gap;
      heap_[count_++] = static_cast<int>(i);
    }
    for (std::size_t place = count_ / 2; place-- > 0;) sink(place);
  }
  int number() const noexcept { return heap_[0]; }
  double gap() const noexcept { return gap_[at(heap_[0])]; }
  /// The candidate with that number has become another one, with this gap. O(log(number of candidates)).
  void replace(double gap) noexcept {
    gap_[at(heap_[0])] = gap;
    sink(0);
  }

 private:
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  bool is_before(int a, int b) const noexcept {
    return gap_[at(a)] > gap_[at(b)] || (gap_[at(a)] == gap_[at(b)] && a < b);
  }
  void sink(std::size_t place) noexcept {
    const int number = heap_[place];
    for (std::size_t child = 2 * place + 1; child < count_; child = 2 * place + 1) {
      if (child + 1 < count_ && is_before(heap_[child + 1], heap_[child])) ++child;
      if (!is_before(heap_[child], number)) break;
      heap_[place] = heap_[child];
      place = child;
    }
    heap_[place] = number;
  }

  std::vector<double> gap_;  // per candidate
  std::vector<int> heap_;    // numbers of candidates
  std::size_t count_ = 0;    // of the heap
};

}}}  // namespace palpate::detail
