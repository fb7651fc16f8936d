#include <palpate/core/status.hpp>
#include <set>
#include <sstream>
#include <type_traits>

#include "catch.hpp"

using namespace palpate;

static_assert(std::is_trivially_copyable_v<Status> && sizeof(Status) == 4);
static_assert(Status{}.ok());
static_assert((Status{StatusFlag::stale} | StatusFlag::saturated).has(StatusFlag::saturated));

TEST_CASE("a status is a set of flags", "[core][status]") {
  Status s;
  CHECK(s.ok());
  CHECK(s.bits() == 0);
  s.set(StatusFlag::saturated);
  s.set(StatusFlag::saturated);
  CHECK_FALSE(s.ok());
  CHECK(s.has(StatusFlag::saturated));
  CHECK_FALSE(s.has(StatusFlag::stale));
  CHECK(s == Status(StatusFlag::saturated));

  s |= StatusFlag::stale;
  const Status both = Status(StatusFlag::stale) | StatusFlag::saturated;
  CHECK(s == both);
  CHECK((s | Status{}) == s);
}

TEST_CASE("a status prints the names of its flags", "[core][status]") {
  const auto printed = [](Status status) {
    std::ostringstream out;
    out << status;
    return out.str();
  };
  CHECK(printed({}) == "ok");
  CHECK(printed(StatusFlag::stale) == "Stale");
  CHECK(printed(Status(StatusFlag::ramping) | StatusFlag::saturated) == "Saturated Ramping");
}

TEST_CASE("every flag has one bit and one name", "[core][status]") {
  std::set<std::string_view> names;
  for (int bit = 0; bit < status_flag_count; ++bit) names.insert(status_flag_name(bit));
  CHECK(names.size() == static_cast<std::size_t>(status_flag_count));
  CHECK(names.count("") == 0);
  const auto name = [](StatusFlag f) { return status_flag_name(std::countr_zero(static_cast<std::uint32_t>(f))); };
  CHECK(name(StatusFlag::non_finite_input) == "NonFiniteInput");
  CHECK(name(StatusFlag::saturated) == "Saturated");
  CHECK(name(StatusFlag::slew_limited) == "SlewLimited");
  CHECK(name(StatusFlag::stale) == "Stale");
  CHECK(name(StatusFlag::deadline_missed) == "DeadlineMissed");
  CHECK(name(StatusFlag::inverted) == "Inverted");
  CHECK(name(StatusFlag::solver_not_converged) == "SolverNotConverged");
  CHECK(name(StatusFlag::energy_injected) == "EnergyInjected");
  CHECK(name(StatusFlag::degraded_model) == "DegradedModel");
  CHECK(name(StatusFlag::disconnected) == "Disconnected");
  CHECK(name(StatusFlag::reacquired) == "Reacquired");
  CHECK(name(StatusFlag::ramping) == "Ramping");
  CHECK(name(StatusFlag::non_finite_force) == "NonFiniteForce");
  CHECK(name(StatusFlag::step_refused) == "StepRefused");
  CHECK(name(StatusFlag::energy_grew) == "EnergyGrew");
  CHECK(name(StatusFlag::slow_tissue) == "SlowTissue");
  CHECK(name(StatusFlag::coarse_contact) == "CoarseContact");
  CHECK(name(StatusFlag::large_displacement) == "LargeDisplacement");
  CHECK(name(StatusFlag::lost_contact) == "LostContact");
  CHECK(name(StatusFlag::material_exceeded) == "MaterialExceeded");
  CHECK(name(StatusFlag::stalled_tissue) == "StalledTissue");
}

TEST_CASE("counters add one per set flag and tick", "[core][status]") {
  StatusCounters counters;
  for (int bit = 0; bit < status_flag_count; ++bit) CHECK(counters.at(bit) == 0);
  for (int tick = 0; tick < 1000; ++tick) {
    Status s;
    if (tick % 2 == 0) s |= StatusFlag::saturated;
    if (tick % 10 == 0) s |= StatusFlag::material_exceeded;
    counters.count(s);
  }
  CHECK(counters[StatusFlag::saturated] == 500);
  CHECK(counters[StatusFlag::material_exceeded] == 100);
  CHECK(counters[StatusFlag::stale] == 0);
  CHECK(counters.at(1) == 500);
  CHECK(counters.at(19) == 100);
  CHECK(counters.at(status_flag_count - 1) == 0);
  STATIC_REQUIRE(noexcept(counters.count(Status{})));
  std::ostringstream out;
  out << counters << "; " << StatusCounters{};
  CHECK(out.str() == "Saturated 500 MaterialExceeded 100; ok");
}
