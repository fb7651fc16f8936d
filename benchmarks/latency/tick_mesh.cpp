// The tick over the size of the body and the number of contacts. Patch, contact points and weights are always the same.
#include "palpation.hpp"

namespace {

using namespace latency;
using Session = Palpation<palpate::Condensed<palpate::SelectiveInverse>>;

void run(benchmark::State& state, Session& s, int contacts) {
  s.press_until(contacts);
  sample_ticks(state, [&] { benchmark::DoNotOptimize(s.tick()); });
  s.describe(state);
  const double error = s.gap_error();
  if (!(error < 1e-5)) state.SkipWithError("the pressed points are not on the sphere");
  state.counters["gap_err"] = error;
}

/// Ten contacts on bodies of different size.
void by_mesh(benchmark::State& state) {
  Session s(blocks[static_cast<std::size_t>(state.range(0))]);
  run(state, s, 10);
}
BENCHMARK(by_mesh)->Name("tick/block")->DenseRange(0, static_cast<int>(blocks.size()) - 1)->Apply(as_ticks);

/// Ten contacts on one body with touchable patches of different size.
void by_kept(benchmark::State& state) {
  Session s({blocks[1].beside, blocks[1].below, static_cast<int>(state.range(0))});
  run(state, s, 10);
}
BENCHMARK(by_kept)->Name("tick/touched_cells")->Arg(8)->Arg(12)->Arg(16)->Apply(as_ticks);

void by_contacts(benchmark::State& state) {
  static Session s(blocks[1]);
  run(state, s, static_cast<int>(state.range(0)));
}
BENCHMARK(by_contacts)->Name("tick/contacts")->Arg(1)->Arg(3)->Arg(10)->Arg(30)->Apply(as_ticks);

}  // namespace
