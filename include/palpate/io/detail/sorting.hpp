// Sorting shared by several readers, so that it is compiled once.
#pragma once

#include <palpate/core/types.hpp>

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

}}}  // namespace palpate::PALPATE_ABI::io

#if PALPATE_HEADER_ONLY
#include <palpate/io/detail/sorting.ipp>
#endif
