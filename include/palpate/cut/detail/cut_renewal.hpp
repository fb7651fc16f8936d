// A new factor of a body while cutting continues.
#pragma once

#include <palpate/concepts/element.hpp>
#include <palpate/core/config.hpp>
#include <palpate/core/detail/attempt.hpp>
#include <palpate/core/setup_options.hpp>
#include <palpate/core/types.hpp>
#include <palpate/cut/detail/cut_physics.hpp>
#include <palpate/cut/detail/cut_system.hpp>
#include <palpate/cut/cut_topology.hpp>
#include <palpate/cut/detail/topology_difference.hpp>

#include <atomic>
#include <memory>
#include <thread>
#include <utility>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Builds a system of the current topology in a background thread. Cuts may continue meanwhile: `take` adds all later
/// cuts as one. The destructor waits for the thread. `physics` must outlive it.
template <Element E>
class CutRenewal {
 public:
  CutRenewal(const CutTopology<E>& topology, const CutPhysics<E>& physics, std::vector<NodeId> kept_nodes,
             const SetupLimits& limits)
      : then_(topology),
        thread_([this, &physics, kept = std::move(kept_nodes), limits] { make(physics, kept, limits); }) {}
  ~CutRenewal() {
    if (thread_.joinable()) thread_.join();
  }
  CutRenewal(const CutRenewal&) = delete;
  CutRenewal& operator=(const CutRenewal&) = delete;

  bool is_done() const noexcept { return done_.load(std::memory_order_acquire); }
  /// Call when it is done: returns the system with the later cuts, folded, or null if it could not be built. Throws as
  /// CutSystem::update.
  std::unique_ptr<CutSystem<E>> take(const CutTopology<E>& now) {
    if (!made_) return nullptr;
    made_->update(now, difference(then_, now));
    made_->fold();
    return std::move(made_);
  }

 private:
  void make(const CutPhysics<E>& physics, const std::vector<NodeId>& kept, const SetupLimits& limits) noexcept {
    // Out of memory or cancelled: nothing is made, and the old system stays.
    attempt([&] { made_ = std::make_unique<CutSystem<E>>(then_, physics, kept, limits); });
    done_.store(true, std::memory_order_release);
  }

  CutTopology<E> then_;
  std::unique_ptr<CutSystem<E>> made_;
  std::atomic<bool> done_{false};
  std::thread thread_;  // declared last: it uses all other members
};

}}}  // namespace palpate::detail
