// Random contact sessions never lose the tissue. PALPATE_TORTURE_SESSIONS sets their number: `sh cmake/run torture`.
#include "contact_torture.hpp"

#include "catch.hpp"

#include <cstdlib>

namespace {

TEST_CASE("random tools on random bodies never lose the tissue", "[extreme][torture][D4][D10][D11][D12][D13][D14]") {
  const char* wanted = std::getenv("PALPATE_TORTURE_SESSIONS");
  const int sessions = wanted != nullptr ? std::atoi(wanted) : 12;
  const test::TortureCounts counts = test::torture(1, sessions, 2000, wanted != nullptr);
  std::printf(
      "contact torture: %ld sessions, %ld ticks, %ld ticks of tools with force, %ld steady presses\n"
      "  flagged: reacquired %ld, not converged %ld, degraded %ld\n"
      "  at an everted surface %ld; of the jumps, from a flagged force %ld\n"
      "  lost %ld, unsettled %ld, inside %ld, jumps %ld, not finite %ld, energy gained %ld\n",
      counts.sessions, counts.ticks, counts.pressed, counts.steady, counts.reacquired, counts.not_converged,
      counts.degraded, counts.everted, counts.caught_up, counts.lost, counts.unsettled, counts.inside, counts.jumps,
      counts.non_finite, counts.energy_gained);
  CHECK(counts.pressed > counts.ticks / 10);
  CHECK(counts.steady > sessions / 10);
  CHECK(counts.lost == 0);
  CHECK(counts.unsettled == 0);
  CHECK(counts.inside == 0);
  CHECK(counts.jumps == 0);
  CHECK(counts.non_finite == 0);
  CHECK(counts.energy_gained == 0);
}

TEST_CASE("sessions in which a force once was zero, jumped or did not settle", "[extreme][torture][D10][D11][D14]") {
  const std::uint64_t seed = GENERATE(1908, 2112, 3419, 4877, 5326, 6797, 7436, 8156, 8508, 8612, 9386);
  const test::TortureCounts counts = test::torture(seed, 1, 2000, true);
  INFO("seed " << seed);
  CHECK(counts.lost == 0);
  CHECK(counts.unsettled == 0);
  CHECK(counts.inside == 0);
  CHECK(counts.jumps == 0);
}

}  // namespace
