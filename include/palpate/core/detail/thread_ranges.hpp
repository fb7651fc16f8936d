// A loop divided among threads.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/executor.hpp>
#include <palpate/core/types.hpp>

#include <algorithm>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Calls work(thread, begin, end) for consecutive, equally long ranges of 0 ... count - 1, at least `least` long; for
/// one range in the calling thread. Returns when all have returned.
template <class Work>
void thread_ranges(Index count, Index least, const SetupThreads& threads, Work&& work) {
  const auto parts = static_cast<int>(std::clamp<Index>(count / least, 1, threads.threads()));
  if (parts == 1) return work(0, Index{0}, count);
  threads.run(parts, [&](int i) { work(i, count * i / parts, count * (i + 1) / parts); });
}

}}}  // namespace palpate::detail
