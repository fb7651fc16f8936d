// Definitions of admission_policy.hpp.
#pragma once

#include <palpate/mesh/admission_policy.hpp>

#include <string>

namespace palpate { inline namespace PALPATE_ABI { namespace detail {

PALPATE_INLINE SetupProblem make_problem(const AdmissionRule& rule, const Finding& finding) {
  SetupProblem p;
  p.kind = rule.kind;
  p.what = std::to_string(finding.count) + ' ' + rule.what + ", worst " + number(finding.worst) + ", bound " +
           number(finding.threshold);
  p.hint = rule.hint;
  p.ids = finding.ids;
  p.ids_of = rule.of_nodes ? SetupIds::nodes : SetupIds::elements;
  p.count = finding.count;
  p.value = finding.worst;
  p.threshold = finding.threshold;
  return p;
}

PALPATE_INLINE void require_usable(const AdmissionPolicy& policy) {
  const MeshThresholds& t = policy.thresholds;
  for (double bound : {t.degenerate, t.poor_quality, t.quality_floor, t.coincidence, t.millimetres})
    if (!(bound >= 0.0))
      raise(SetupErrorKind::bad_argument, "a mesh threshold is " + number(bound), "Give zero or more");
  for (const AdmissionRule& rule : admission_rules)
    if (rule.decision != nullptr && !rule.can_repair && policy.*(rule.decision) == Admission::repair)
      raise(SetupErrorKind::unsupported, "there is no repair for " + std::string(to_string(rule.kind)),
            "Choose refuse or accept");
}

}}}  // namespace palpate::detail
