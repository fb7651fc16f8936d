// Work and span of a factorisation: how fast more threads would make it, from the time of every front in one thread.
#pragma once

#include <palpate/linear/detail/cholesky_analysis.hpp>

#include <vector>

namespace bench {

/// Time of one front [s]. `shared` is done in pieces by all threads without a task of their own.
struct FrontTime {
  double serial = 0.0, shared = 0.0;
  double longest = 0.0;  ///< of `shared` with any number of threads
};

/// A factorisation with a number of threads.
struct Predicted {
  double seconds = 0.0;
  double one_task = 0.0;    ///< share of the time in which only one task runs: the fronts at the root
  double not_shared = 0.0;  ///< share of the time in which threads are idle because the running parts are serial
};

/// Eliminates every front in one thread and times it, while `threads` - 1 others do the same with a copy of their own:
/// they share caches and memory as the threads of one factorisation do. Means of the threads.
std::vector<FrontTime> time_fronts(const palpate::detail::CholeskyAnalysis& analysis,
                                   const palpate::detail::SparseLower& lower, int threads);

/// Repeats the decisions of ParallelFronts with these times: first ready task first, idle threads share large fronts.
Predicted predict(const palpate::detail::CholeskyAnalysis& analysis, const std::vector<FrontTime>& times, int threads);

}  // namespace bench
