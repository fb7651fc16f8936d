// Factorisation that can be repeated for other values on the same pattern, in one thread.
#pragma once

#include <palpate/linear/detail/cholesky_analysis.hpp>
#include <palpate/linear/detail/front_work.hpp>
#include <palpate/linear/detail/pivot_check.hpp>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Eliminates one front after the other into `factor`.
class FrontFactorisation {
 public:
  FrontFactorisation(const CholeskyAnalysis& analysis, double* factor, double threshold)
      : system_(analysis.tree(), factor, threshold),
        work_(analysis.tree(), analysis.pack_size()),
        workspace_(analysis.tree().workspace_size + 64) {
    for (Index f = 0; f < system_.tree.fronts.size(); ++f)
      system_.updates[f] = workspace_.data() + system_.tree.fronts[f].update;
  }

  /// Refers to the values of a matrix with the analysed pattern; they must stay valid until elimination is done.
  void take(const SparseLower& lower) noexcept { system_.take(lower); }

  /// Eliminates all fronts; returns false when a pivot fails. No allocation.
  bool try_eliminate() noexcept {
    for (Index f = 0; f < system_.tree.fronts.size(); ++f) {
      const Front& front = system_.tree.fronts[f];
      work_.eliminate(system_, f, nullptr);
      for (Index i = front.first; i < front.first + front.pivots; ++i)
        if (!pivot_is_good(system_.pivots.data()[i], system_.diagonal.data()[i], system_.threshold)) return false;
    }
    return true;
  }

 private:
  FrontSystem system_;
  FrontWork work_;
  BigArray workspace_;
};

}}}  // namespace palpate::detail
