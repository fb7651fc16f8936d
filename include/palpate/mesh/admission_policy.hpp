// What to do with a defective mesh: the decisions of the caller, and the messages of refusals.
#pragma once

#include <palpate/core/config.hpp>
#include <palpate/core/setup_error.hpp>
#include <palpate/mesh/diagnosis.hpp>

#include <array>
#include <string>

namespace palpate { inline namespace PALPATE_ABI {

/// What to do about a defect: refuse the mesh, repair it, or accept it as it is. All three report it in the diagnosis.
enum class Admission { refuse, repair, accept };

/// One decision per defect. Unusable indices, positions that are not finite, empty meshes and slivers below
/// `thresholds.quality_floor` are always refused. There is no repair for poor_quality and units.
struct AdmissionPolicy {
  Admission inverted = Admission::refuse;    ///< repair: node order mirrored (Tet4: two nodes swapped)
  Admission degenerate = Admission::refuse;  ///< repair: element dropped
  Admission poor_quality = Admission::accept;
  Admission duplicate_nodes = Admission::refuse;     ///< repair: welded into the lowest of them
  Admission duplicate_elements = Admission::refuse;  ///< repair: all but the first dropped
  Admission orphans = Admission::repair;  ///< repair: node dropped. If accepted, it gives a zero row in the stiffness
  Admission disconnected = Admission::accept;  ///< repair: all pieces but the one of most elements dropped
  Admission units = Admission::accept;
  MeshThresholds thresholds;
};

namespace detail {

/// A row of the table below: finding, decision and message.
struct AdmissionRule {
  SetupErrorKind kind;
  Finding MeshDiagnosis::*finding;
  Admission AdmissionPolicy::*decision;  ///< null: always refused
  bool of_nodes;
  bool can_repair;
  const char* what;
  const char* hint;
};

inline constexpr std::array<AdmissionRule, 11> admission_rules{{
    {SetupErrorKind::index_out_of_range, &MeshDiagnosis::index_out_of_range, nullptr, false, false,
     "elements name a node or region that does not exist", "Ids count from zero; a file may count from one"},
    {SetupErrorKind::non_finite, &MeshDiagnosis::non_finite, nullptr, true, false,
     "positions are not finite or beyond 1e100", "Check the program that wrote these positions"},
    {SetupErrorKind::duplicate_node, &MeshDiagnosis::duplicate_nodes, &AdmissionPolicy::duplicate_nodes, true, true,
     "nodes coincide with another one (distance / local edge)", "Weld them: duplicate_nodes = Admission::repair"},
    {SetupErrorKind::duplicate_element, &MeshDiagnosis::duplicate_elements, &AdmissionPolicy::duplicate_elements, false,
     true, "elements repeat another one", "Drop them: duplicate_elements = Admission::repair"},
    {SetupErrorKind::degenerate_element, &MeshDiagnosis::degenerate, &AdmissionPolicy::degenerate, false, true,
     "elements are flat (volume / longest edge^3)", "Drop them: degenerate = Admission::repair"},
    {SetupErrorKind::inverted_element, &MeshDiagnosis::inverted, &AdmissionPolicy::inverted, false, true,
     "elements are inverted (volume / longest edge^3)", "Reverse them: inverted = Admission::repair"},
    {SetupErrorKind::poor_quality, &MeshDiagnosis::slivers, nullptr, false, false, "elements are slivers (mean ratio)",
     "Remesh, or lower thresholds.quality_floor and expect inaccurate forces"},
    {SetupErrorKind::poor_quality, &MeshDiagnosis::poor_quality, &AdmissionPolicy::poor_quality, false, false,
     "elements are of poor quality (mean ratio)", "Remesh, or poor_quality = Admission::accept"},
    {SetupErrorKind::orphan_node, &MeshDiagnosis::orphans, &AdmissionPolicy::orphans, true, true,
     "nodes belong to no element", "Drop them: orphans = Admission::repair"},
    {SetupErrorKind::disconnected, &MeshDiagnosis::disconnected, &AdmissionPolicy::disconnected, true, true,
     "components share no node (first node of each)",
     "Weld coincident nodes, keep the largest piece: disconnected = Admission::repair, or Admission::accept"},
    {SetupErrorKind::suspicious_units, &MeshDiagnosis::units, &AdmissionPolicy::units, true, false,
     "mesh is larger than two metres across (diagonal [m])", "Positions are metres; scale millimetres by 0.001"},
}};

/// Converts a finding to a refusal.
PALPATE_COLD inline SetupProblem make_problem(const AdmissionRule& rule, const Finding& finding) {
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

/// Refuses a policy that requests a repair that does not exist, or with a NaN or negative bound: with NaN every check
/// would pass.
inline void require_usable(const AdmissionPolicy& policy) {
  const MeshThresholds& t = policy.thresholds;
  for (double bound : {t.degenerate, t.poor_quality, t.quality_floor, t.coincidence, t.millimetres})
    if (!(bound >= 0.0))
      raise(SetupErrorKind::bad_argument, "a mesh threshold is " + number(bound), "Give zero or more");
  for (const AdmissionRule& rule : admission_rules)
    if (rule.decision != nullptr && !rule.can_repair && policy.*(rule.decision) == Admission::repair)
      raise(SetupErrorKind::unsupported, "there is no repair for " + std::string(to_string(rule.kind)),
            "Choose refuse or accept");
}

}  // namespace detail

}}  // namespace palpate
