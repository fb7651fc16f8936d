// Definitions of fibres.hpp.
#pragma once

#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/detail/fibres.hpp>

#include <cmath>
#include <string>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE void require_fibre_count(std::size_t fibres, Index element_count) {
  if (static_cast<Index>(fibres) != element_count)
    raise(SetupErrorKind::bad_argument, "the mesh has " + std::to_string(fibres) + " fibre directions",
          "It needs one per element, " + std::to_string(element_count) + ", or none");
}

PALPATE_INLINE void require_unit_vectors(std::span<const Vector3> fibres) {
  std::vector<std::int64_t> bad;
  double worst = 1.0;
  for (std::size_t e = 0; e < fibres.size(); ++e) {
    const double length = fibres[e].norm();
    if (std::abs(length - 1.0) <= fibre_length_tolerance) continue;
    if (!(std::abs(length - 1.0) <= std::abs(worst - 1.0))) worst = length;  // NaN is worst
    bad.push_back(static_cast<std::int64_t>(e));
  }
  if (bad.empty()) return;
  SetupProblem p;
  p.kind = SetupErrorKind::bad_argument;
  p.what = std::to_string(bad.size()) + " elements have a fibre direction that is not a unit vector, worst length " +
           number(worst);
  p.hint = "Give a unit vector for every element, or for none";
  p.set_ids(bad, SetupIds::elements);
  p.value = worst;
  p.threshold = fibre_length_tolerance;
  raise(std::move(p));
}

}}}  // namespace palpate::detail
