// Errors of the tick: a word of flags that accompanies every force.
#pragma once

#include <palpate/core/config.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <iosfwd>
#include <ostream>
#include <string_view>

namespace palpate { inline namespace PALPATE_ABI {

enum class StatusFlag : std::uint32_t {
  non_finite_input = 1u << 0,      ///< the device returned NaN, infinity or an invalid rotation
  saturated = 1u << 1,             ///< force clamped to the limit, direction kept
  slew_limited = 1u << 2,          ///< change of force per tick limited
  stale = 1u << 3,                 ///< input older than allowed: force is faded to zero
  deadline_missed = 1u << 4,       ///< the tick came later than its period allows
  inverted = 1u << 5,              ///< an element is inverted (non-linear models)
  solver_not_converged = 1u << 6,  ///< contact or linear solver stopped at its iteration limit; or the force goes back
                                   ///< and forth from tick to tick
  energy_injected = 1u << 7,       ///< the energy tank is nearly empty: forces are scaled down
  degraded_model = 1u << 8,        ///< something was omitted to stay within bounds (contact capacity, late compliance)
  disconnected = 1u << 9,          ///< the device reports invalid data
  reacquired = 1u << 10,           ///< the tool jumped: contact was restarted
  ramping = 1u << 11,              ///< start-up ramp is scaling the force
  non_finite_force = 1u << 12,     ///< a computed force was not finite and was replaced by zero
  step_refused = 1u << 13,         ///< the time step is not positive or above the stability limit: no step was made
  energy_grew = 1u << 14,          ///< a motion gained energy without a source: it is kept at its last good state
  slow_tissue = 1u << 15,  ///< computing a tissue step takes longer than its time step: the tissue moves in slow motion
  coarse_contact = 1u << 16,  ///< the tool is smaller than the facets: its indentation is mostly estimated, or omitted;
                              ///< or the error of the force is above a tenth of it, as measured or by the facets;
                              ///< or an edge, a support or another material is near, or few elements bend there
  large_displacement = 1u << 17,  ///< loads or a tool displace the tissue too far for linear elasticity
  lost_contact = 1u << 18,       ///< the tool is inside the tissue: it passed through the surface, or entered where the
                                 ///< body cannot be touched; its force is zero, or points the wrong way
  material_exceeded = 1u << 19,  ///< an element is compressed or stretched beyond the range of its material law, which
                                 ///< yields there: forces are too small, or pull (non-linear models)
  stalled_tissue = 1u << 20,     ///< the tissue has work that nobody does: steps or cuts without a BackgroundWorker or
                                 ///< calls of advance() or process_cuts(), or a worker that has failed
};

/// Number of flags that exist.
inline constexpr int status_flag_count = 21;

/// A set of StatusFlag. Trivially copyable; no operation allocates.
class Status {
 public:
  constexpr Status() = default;
  constexpr Status(StatusFlag flag)
      : bits_(static_cast<std::uint32_t>(flag)) {}  // NOLINT(google-explicit-constructor): a flag is a status
  constexpr void set(StatusFlag flag) noexcept { bits_ |= static_cast<std::uint32_t>(flag); }
  constexpr bool has(StatusFlag flag) const noexcept { return (bits_ & static_cast<std::uint32_t>(flag)) != 0; }
  constexpr bool ok() const noexcept { return bits_ == 0; }
  constexpr std::uint32_t bits() const noexcept { return bits_; }
  constexpr Status& operator|=(Status other) noexcept {
    bits_ |= other.bits_;
    return *this;
  }
  friend constexpr Status operator|(Status a, Status b) noexcept { return a |= b; }
  friend constexpr bool operator==(Status, Status) = default;

 private:
  std::uint32_t bits_ = 0;
};

/// Name of flag number `bit` (0 ... status_flag_count - 1).
constexpr std::string_view status_flag_name(int bit) {
  constexpr std::array<std::string_view, status_flag_count> names{
      "NonFiniteInput",     "Saturated",        "SlewLimited",   "Stale",        "DeadlineMissed", "Inverted",
      "SolverNotConverged", "EnergyInjected",   "DegradedModel", "Disconnected", "Reacquired",     "Ramping",
      "NonFiniteForce",     "StepRefused",      "EnergyGrew",    "SlowTissue",   "CoarseContact",  "LargeDisplacement",
      "LostContact",        "MaterialExceeded", "StalledTissue"};
  return names[static_cast<std::size_t>(bit)];
}

/// Prints the names of all flags that are set, for example "Saturated Ramping", or "ok". Not for the tick.
std::ostream& operator<<(std::ostream& out, Status status);

/// How often each flag was raised; one addition per set flag and tick.
class StatusCounters {
 public:
  void count(Status status) noexcept;
  std::uint64_t operator[](StatusFlag flag) const noexcept;
  std::uint64_t at(int bit) const noexcept { return counts_[static_cast<std::size_t>(bit)]; }

 private:
  std::array<std::uint64_t, status_flag_count> counts_{};
};

/// Prints every flag that was raised and how often, for example "Saturated 12 Ramping 33", or "ok". Not for the tick.
std::ostream& operator<<(std::ostream& out, const StatusCounters& counters);

inline std::ostream& operator<<(std::ostream& out, Status status) {
  if (status.ok()) return out << "ok";
  const char* between = "";
  for (int bit = 0; bit < status_flag_count; ++bit) {
    if ((status.bits() >> bit & 1u) == 0) continue;
    out << between << status_flag_name(bit);
    between = " ";
  }
  return out;
}

inline std::ostream& operator<<(std::ostream& out, const StatusCounters& counters) {
  const char* between = "";
  for (int bit = 0; bit < status_flag_count; ++bit) {
    if (counters.at(bit) == 0) continue;
    out << between << status_flag_name(bit) << ' ' << counters.at(bit);
    between = " ";
  }
  return *between == 0 ? out << "ok" : out;
}

inline void StatusCounters::count(Status status) noexcept {
  for (std::uint32_t bits = status.bits(); bits != 0; bits &= bits - 1)
    ++counts_[static_cast<std::size_t>(std::countr_zero(bits))];
}

inline std::uint64_t StatusCounters::operator[](StatusFlag flag) const noexcept {
  return counts_[static_cast<std::size_t>(std::countr_zero(static_cast<std::uint32_t>(flag)))];
}

}}  // namespace palpate
