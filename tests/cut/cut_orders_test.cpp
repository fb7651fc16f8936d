// Cut orders between threads.
#include <palpate/cut/detail/cut_orders.hpp>

#include "catch.hpp"

#include <thread>

using namespace palpate;

namespace {

CutOrder removal(Index element) {
  CutOrder order;
  order.remove.push_back(element);
  return order;
}

}  // namespace

TEST_CASE("all orders are taken as one, only once, and are open until done", "[cut][orders]") {
  detail::CutOrders orders;
  CHECK_FALSE(orders.are_open());
  CHECK(orders.take().count == 0);
  orders.add(removal(3));
  CutOrder faces;
  faces.open.push_back({7, 2});
  orders.add(faces);
  orders.add(BladeSweep{});
  CHECK(orders.try_add(BladeSweep{}));
  CHECK(orders.are_open());
  const detail::CutOrders::Taken taken = orders.take();
  CHECK(taken.count == 4);
  CHECK(taken.order.remove == std::vector<Index>{3});
  REQUIRE(taken.order.open.size() == 1);
  CHECK(taken.order.open[0].element == 7);
  CHECK(taken.order.open[0].face == 2);
  CHECK(taken.sweeps.size() == 2);
  CHECK(orders.take().count == 0);
  CHECK(orders.are_open());
  orders.add(removal(4));  // while the others are processed
  orders.done(taken);
  CHECK(orders.are_open());
  orders.done(orders.take());
  CHECK_FALSE(orders.are_open());
}

TEST_CASE("a tick is notified when too many sweeps wait, and none is lost", "[cut][orders][extreme]") {
  detail::CutOrders orders;
  unsigned accepted = 0;
  while (accepted < 1000 && orders.try_add(BladeSweep{})) ++accepted;
  CHECK(accepted >= 255);
  CHECK(accepted <= 256);
  const detail::CutOrders::Taken taken = orders.take();
  CHECK(taken.count == accepted);
  CHECK(taken.sweeps.size() == accepted);
  orders.done(taken);
  CHECK_FALSE(orders.are_open());
  CHECK(orders.try_add(BladeSweep{}));
}

TEST_CASE("orders from two threads reach a third thread exactly once", "[cut][orders]") {
  constexpr Index each = 2000;
  detail::CutOrders orders;
  std::thread first([&] {
    for (Index i = 0; i < each; ++i) orders.add(removal(i));
  });
  std::thread second([&] {
    for (Index i = each; i < 2 * each; ++i) orders.add(removal(i));
  });
  std::vector<int> seen(static_cast<std::size_t>(2 * each), 0);
  std::size_t count = 0;
  while (count < seen.size()) {
    const detail::CutOrders::Taken taken = orders.take();
    for (const Index e : taken.order.remove) ++seen[static_cast<std::size_t>(e)];
    count += taken.count;
    orders.done(taken);
  }
  first.join();
  second.join();
  CHECK(std::count(seen.begin(), seen.end(), 1) == 2 * each);
  CHECK_FALSE(orders.are_open());
}

TEST_CASE("orders are stalled when nobody processes them, not while calls take or wait for long", "[cut][orders]") {
  detail::CutServed served;
  const auto stalled_within = [&](int ticks) {
    bool any = false;
    for (int k = 0; k < ticks; ++k) any = served.is_stalled(true) || any;
    return any;
  };
  CHECK_FALSE(stalled_within(detail::CutServed::patience));
  CHECK(stalled_within(1));
  {
    const detail::CutServed::Call working(served), waiting(served);  // of two threads
    CHECK_FALSE(stalled_within(3 * detail::CutServed::patience));
  }
  CHECK_FALSE(stalled_within(detail::CutServed::patience));
  CHECK(stalled_within(1));
  CHECK_FALSE(served.is_stalled(false));  // nothing waits
  served.report_failed(true);
  CHECK(served.is_stalled(false));
  { const detail::CutServed::Call call(served); }
  CHECK_FALSE(served.is_stalled(false));
}
