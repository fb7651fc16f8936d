#include "work_and_span.hpp"

#include <palpate/core/executor.hpp>
#include <palpate/core/platform.hpp>
#include <palpate/linear/detail/front_tasks.hpp>
#include <palpate/linear/detail/front_work.hpp>
#include <palpate/linear/sparse_cholesky.hpp>

#include <algorithm>
#include <functional>
#include <queue>

namespace bench {
namespace {

using namespace palpate;

/// Time of this thread: other programs do not count.
double now() {
  return 1e-9 * static_cast<double>(platform::compute_ns());
}

/// Does all pieces in this thread and times them.
class TimedTeam final : public detail::FrontTeam {
 public:
  FrontTime time;

 private:
  void run(Index count, void* piece, void (*call)(void*, Index)) noexcept override {
    double longest = 0.0;
    for (Index i = 0; i < count; ++i) {
      const double start = now();
      call(piece, i);
      const double seconds = now() - start;
      time.shared += seconds;
      longest = std::max(longest, seconds);
    }
    time.longest += longest;
  }
};

/// One thread per running task; the others help the first one whose present part is shared.
class Simulation {
 public:
  Simulation(const detail::CholeskyAnalysis& analysis, const std::vector<FrontTime>& times, int threads)
      : division_(detail::divide_fronts(analysis.tree(), analysis.front_count())),
        times_(times),
        threads_(threads),
        most_ahead_(division_.ahead(threads)),
        waiting_(static_cast<std::size_t>(division_.tasks.size())),
        done_(waiting_.size(), false),
        is_ahead_(waiting_.size(), false) {
    for (std::size_t t = 0; t < waiting_.size(); ++t)
      if ((waiting_[t] = task(t).children) == 0) ready_.push(t);
  }

  Predicted run() {
    while (first_ < done_.size()) {
      start_tasks();
      step();
    }
    predicted_.one_task /= predicted_.seconds;
    predicted_.not_shared /= predicted_.seconds;
    return predicted_;
  }

 private:
  struct Running {
    std::size_t task;
    Index front;
    FrontTime left;
  };

  const detail::FrontTask& task(std::size_t t) const noexcept { return division_.tasks[static_cast<Index>(t)]; }

  void start_tasks() {
    while (!ready_.empty() && static_cast<int>(running_.size()) < threads_) {
      const std::size_t t = ready_.top();
      if (t > first_) {
        if (ahead_ + task(t).update > most_ahead_) return;
        is_ahead_[t] = true;
        ahead_ += task(t).update;
      }
      ready_.pop();
      running_.push_back({t, task(t).begin, times_[static_cast<std::size_t>(task(t).begin)]});
    }
  }

  /// Up to the next end of a part.
  void step() {
    const double idle = threads_ - static_cast<double>(running_.size());
    std::size_t helped = running_.size();
    for (std::size_t r = running_.size(); r-- > 0;)
      if (!(running_[r].left.serial > 0.0) && running_[r].left.longest > 0.0) helped = r;
    const auto rate = [&](std::size_t r) {
      const FrontTime& left = running_[r].left;
      return r == helped ? std::max(1.0, std::min(1.0 + idle, left.shared / left.longest)) : 1.0;
    };
    double seconds = infinity;
    for (std::size_t r = 0; r < running_.size(); ++r) {
      const FrontTime& left = running_[r].left;
      seconds = std::min(seconds, left.serial > 0.0 ? left.serial : left.shared / rate(r));
    }
    predicted_.seconds += seconds;
    if (running_.size() == 1) predicted_.one_task += seconds;
    if (idle > 0.0 && helped == running_.size()) predicted_.not_shared += seconds * idle / threads_;
    for (std::size_t r = 0; r < running_.size(); ++r) {
      FrontTime& left = running_[r].left;
      if (left.serial > 0.0) {
        left.serial = left.serial > seconds ? left.serial - seconds : 0.0;
      } else {
        const double part = std::min(1.0, seconds * rate(r) / left.shared);
        left.longest *= 1.0 - part;
        left.shared = part < 1.0 ? left.shared * (1.0 - part) : 0.0;
      }
    }
    end_parts();
  }

  void end_parts() {
    for (std::size_t r = 0; r < running_.size();) {
      Running& now = running_[r];
      if (now.left.serial > 0.0 || now.left.shared > 0.0) {
        ++r;
      } else if (++now.front < task(now.task).end) {
        now.left = times_[static_cast<std::size_t>(now.front)];
      } else {
        finish(now.task);
        running_.erase(running_.begin() + static_cast<std::ptrdiff_t>(r));
      }
    }
  }

  void finish(std::size_t t) {
    done_[t] = true;
    for (; first_ < done_.size() && done_[first_]; ++first_)
      if (is_ahead_[first_]) ahead_ -= task(first_).update;
    if (task(t).parent < 0) return;
    const auto parent = static_cast<std::size_t>(task(t).parent);
    if (--waiting_[parent] == 0) ready_.push(parent);
  }

  detail::FrontTasks division_;
  const std::vector<FrontTime>& times_;
  int threads_;
  Index most_ahead_, ahead_ = 0;
  std::vector<NodeId> waiting_;
  std::vector<bool> done_, is_ahead_;
  std::priority_queue<std::size_t, std::vector<std::size_t>, std::greater<>> ready_;
  std::vector<Running> running_;
  std::size_t first_ = 0;
  Predicted predicted_;
};

/// One factorisation in this thread.
std::vector<FrontTime> time_copy(const detail::CholeskyAnalysis& analysis, const detail::SparseLower& lower) {
  constexpr double shared_flops = 3e7;  // as in ParallelFronts
  const detail::FrontTree& tree = analysis.tree();
  detail::BigArray factor(tree.factor_size + 64), updates(tree.workspace_size + 64);
  for (detail::BigArray* a : {&factor, &updates}) std::fill_n(a->data(), a->size(), 0.0);  // page faults do not count
  detail::FrontSystem system(tree, factor.data(), SparseCholesky::pivot_threshold);
  system.refer_to(lower);
  detail::FrontWork work(tree, analysis.pack_size());
  std::vector<FrontTime> times;
  for (Index f = 0; f < tree.fronts.size(); ++f) {
    system.updates[f] = updates.data() + tree.fronts[f].update;
    TimedTeam team;
    const double start = now();
    work.eliminate(system, f, tree.fronts[f].flops() > shared_flops ? &team : nullptr);
    team.time.serial = std::max(1e-9, now() - start - team.time.shared);
    times.push_back(team.time);
  }
  return times;
}

}  // namespace

std::vector<FrontTime> time_fronts(const detail::CholeskyAnalysis& analysis, const detail::SparseLower& lower,
                                   int threads) {
  std::vector<std::vector<FrontTime>> of_thread(static_cast<std::size_t>(threads));
  detail::StartedThreads(threads).run(
      threads, [&](int t) { of_thread[static_cast<std::size_t>(t)] = time_copy(analysis, lower); });
  std::vector<FrontTime> mean(of_thread.front().size());
  for (const std::vector<FrontTime>& times : of_thread)
    for (std::size_t f = 0; f < mean.size(); ++f) {
      mean[f].serial += times[f].serial / threads;
      mean[f].shared += times[f].shared / threads;
      mean[f].longest += times[f].longest / threads;
    }
  return mean;
}

Predicted predict(const detail::CholeskyAnalysis& analysis, const std::vector<FrontTime>& times, int threads) {
  return Simulation(analysis, times, threads).run();
}

}  // namespace bench
