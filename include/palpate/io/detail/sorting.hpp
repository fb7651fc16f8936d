// Sorting shared by several readers, so that it is compiled once.
#pragma once

#include <palpate/core/types.hpp>

#include <algorithm>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

/// An id and its sort key.
struct Ranked {
  Index key, id;
};

/// Sorts by key, then by id.
void sort_ranked(std::vector<Ranked>& all);

/// Sorts numbers and removes duplicates.
void sort_unique(std::vector<int>& numbers);

inline void sort_ranked(std::vector<Ranked>& all) {
  std::sort(all.begin(), all.end(),
            [](const Ranked& a, const Ranked& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
}

inline void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}}}  // namespace palpate::PALPATE_ABI::io
