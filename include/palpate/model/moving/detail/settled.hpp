// Initial equilibrium of moving tissue.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/core/types.hpp>
#include <palpate/model/moving/equilibrium.hpp>

#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

/// Displacement of the equilibrium under all loads [m]. Throws not_converged.
VectorX settled(Equilibrium& statics);

inline VectorX settled(Equilibrium& statics) {
  const EquilibriumReport report = statics.solve();
  if (!report.converged) {
    SetupProblem p;
    p.kind = SetupErrorKind::not_converged;
    p.what = "no equilibrium was found beyond " + number(100.0 * report.fraction) + " % of the loads";
    p.hint = "Set settle = false, or add supports";
    if (const Index worst = report.deformation.worst_element; worst >= 0) {
      p.what += "; the most deformed element has a volume ratio of " + number(report.deformation.smallest_volume_ratio);
      p.set_ids({&worst, 1}, SetupIds::elements);
    }
    raise(std::move(p));
  }
  return statics.displacement();
}

}}}  // namespace palpate::detail
