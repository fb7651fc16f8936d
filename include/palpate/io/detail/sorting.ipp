// Definitions of sorting.hpp.
#pragma once

#include <palpate/io/detail/sorting.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace io {

PALPATE_INLINE void sort_ranked(std::vector<Ranked>& all) {
  std::sort(all.begin(), all.end(),
            [](const Ranked& a, const Ranked& b) { return a.key != b.key ? a.key < b.key : a.id < b.id; });
}

PALPATE_INLINE void sort_unique(std::vector<int>& numbers) {
  std::sort(numbers.begin(), numbers.end());
  numbers.erase(std::unique(numbers.begin(), numbers.end()), numbers.end());
}

}}}  // namespace palpate::PALPATE_ABI::io
