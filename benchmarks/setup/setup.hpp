// The measurements of the program: each measures one stage of set-up, checks its result and adds its rows.
#pragma once

#include "../common/machine.hpp"
#include "../common/row.hpp"

namespace setup {

struct Session {
  bench::RowFile& rows;
  bool long_run;  ///< also measure larger bodies
};

void measure_machine(Session& session);
void measure_assembly(Session& session);
void measure_factorisation(Session& session);
void measure_irregular(Session& session, const char* organ_file);
void measure_threads(Session& session);
void measure_solves(Session& session);
void measure_condensation(Session& session);
void measure_memory(Session& session);
void measure_iterative(Session& session);
void measure_models(Session& session, const char* organ_file);

/// Empty when `value` is at most `allowed`; an error text otherwise.
inline std::string error_over(double value, double allowed, const char* what) {
  return value <= allowed ? std::string()
                          : std::string(what) + " " + bench::with_unit(value / allowed, "times allowed");
}

inline std::string at_size(const char* what, int n) {
  return std::string(what) + ", n = " + std::to_string(n);
}

}  // namespace setup
