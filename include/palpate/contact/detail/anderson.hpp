// Extrapolation of a fixed-point iteration.
#pragma once

#include <palpate/core/types.hpp>

#include <array>
#include <vector>

namespace palpate { inline namespace PALPATE_ABI {

/// Anderson's (1965) acceleration of x -> g(x), as in Walker and Ni (2011): from the last few steps, the combination of
/// results whose residual g(x) - x is least. For a linear map this is GMRES with g as preconditioner. A step is never
/// longer than `longest` residuals, so that a useless extrapolation does little harm. No allocation after construction.
class AndersonAcceleration {
 public:
  /// For up to `capacity` values. Allocates unless that is 0; for set-up.
  explicit AndersonAcceleration(int capacity);

  /// The next map has nothing in common with the last.
  void forget() noexcept { known_ = next_ = 0, has_last_ = false; }
  /// The next map differs from the last by a shift: its residuals are others, their differences are about the same.
  void shift() noexcept { has_last_ = false; }
  /// Replaces `count` results g of the map for x by the next x to try.
  void extrapolate(int count, const double* x, double* g) noexcept;

 private:
  static constexpr int depth = 3;
  static constexpr double longest = 10.0, growth = 2.0;
  struct Step {
    VectorX residual, result;
  };
  static constexpr std::size_t at(int i) noexcept { return static_cast<std::size_t>(i); }
  void add_difference(int count) noexcept;
  void least_residual(int count) noexcept;

  Step last_;
  std::array<Step, depth> difference_;
  std::array<std::array<double, depth>, depth> products_{};  // of differences of residuals
  std::array<double, depth> weight_{};
  VectorX residual_;
  double square_ = 0.0;
  int known_ = 0, next_ = 0;
  bool has_last_ = false;
};

}}  // namespace palpate

#if PALPATE_HEADER_ONLY
#include <palpate/contact/detail/anderson.ipp>
#endif
