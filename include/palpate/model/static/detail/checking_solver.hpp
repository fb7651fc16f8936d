// The prepared solver of a body as the checks of a set-up see it.
#pragma once

#include <palpate/core/setup_options.hpp>
#include <palpate/linear/detail/any_solver.hpp>
#include <palpate/linear/detail/vector_kernels.hpp>

#include <algorithm>
#include <exception>
#include <limits>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// A system as a LinearSolver that solves on the threads of a set-up and reports progress before every solve. After a
/// cancellation it only returns NaN, which ends an estimate; then `require_going_on` throws.
class CheckingSolver {
 public:
  CheckingSolver(AnyStaticSystem& system, const SetupLimits& limits) : system_(system), limits_(limits) {}

  Index size() const noexcept { return system_.size(); }
  SolveReport solve_into(const VectorX& b, VectorX& x) noexcept {
    if (goes_on()) return system_.solve_into(b, x, limits_.threads);
    fill(x, std::numeric_limits<double>::quiet_NaN());
    return {false, 0, std::numeric_limits<double>::quiet_NaN()};
  }
  /// Throws what the report of progress has thrown.
  void require_going_on() const {
#if defined(PALPATE_HAS_EXCEPTIONS)
    if (stopped_) std::rethrow_exception(stopped_);
#endif
  }

 private:
  bool goes_on() noexcept {
    constexpr double usual = 8.0;  // solves of all checks
#if defined(PALPATE_HAS_EXCEPTIONS)
    try {
#endif
      if (!stopped_) limits_.advance("checks", std::min(0.9, solves_++ / usual));
#if defined(PALPATE_HAS_EXCEPTIONS)
    } catch (...) {
      stopped_ = std::current_exception();
    }
#endif
    return !stopped_;
  }

  AnyStaticSystem& system_;
  const SetupLimits& limits_;
  std::exception_ptr stopped_;
  int solves_ = 0;
};

}}}  // namespace palpate::detail
