// Definitions of cut_orders.hpp.
#pragma once

#include <palpate/cut/detail/cut_orders.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void CutOrders::add(CutOrder order) {
  const std::scoped_lock lock(mutex_);
  orders_.push_back(std::move(order));
  open_.fetch_add(1, std::memory_order_release);
}

PALPATE_INLINE void CutOrders::add(const BladeSweep& sweep) {
  const std::scoped_lock lock(mutex_);
  sweeps_.push_back(sweep);
  open_.fetch_add(1, std::memory_order_release);
}

PALPATE_INLINE bool CutOrders::try_add(const BladeSweep& sweep) noexcept {
  if (!from_ticks_.push(sweep)) return false;
  open_.fetch_add(1, std::memory_order_release);
  return true;
}

PALPATE_INLINE CutOrders::Taken CutOrders::take() {
  Taken taken;
  if (!are_open()) return taken;
  {
    const std::scoped_lock lock(mutex_);
    taken.count = static_cast<unsigned>(orders_.size() + sweeps_.size());
    for (const CutOrder& order : orders_) {
      taken.order.remove.insert(taken.order.remove.end(), order.remove.begin(), order.remove.end());
      taken.order.open.insert(taken.order.open.end(), order.open.begin(), order.open.end());
    }
    sweeps_.reserve(sweeps_.size() + most_from_ticks);  // from here on nothing allocates
    orders_.clear();
    taken.sweeps.swap(sweeps_);
  }
  BladeSweep sweep;
  for (std::size_t k = 0; k < most_from_ticks && from_ticks_.pop(sweep); ++k, ++taken.count)
    taken.sweeps.push_back(sweep);
  return taken;
}

}}  // namespace palpate
