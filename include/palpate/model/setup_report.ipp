// Definitions of setup_report.hpp.
#pragma once

#include <palpate/model/setup_report.hpp>
#include <palpate/core/setup_error.hpp>

#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void SetupReport::set(SetupFlag flag, std::string remark) {
  remarks.emplace_back(flag, std::move(remark));
  flags |= static_cast<std::uint32_t>(flag);
}

PALPATE_INLINE void SetupReport::clear(SetupFlag flag) {
  flags &= ~static_cast<std::uint32_t>(flag);
  std::erase_if(remarks, [flag](const auto& remark) { return remark.first == flag; });
}

PALPATE_INLINE void SetupReport::require_accuracy(double wanted) {
  accuracy.wanted = wanted;
  const bool measured = accuracy.places > 0;
  if (wanted == 0.0 || (measured && accuracy.typical <= wanted)) return;
  const auto percent = [](double part) { return number(std::round(1000.0 * part) / 10.0) + " %"; };
  set(SetupFlag::accuracy_not_reached, "the force error is " + (measured ? percent(accuracy.typical) : "not known") +
                                           "; " + percent(wanted) + " is wanted");
}

PALPATE_INLINE double SetupReport::total_seconds() const noexcept {
  double sum = 0.0;
  for (const auto& stage : seconds) sum += stage.second;
  return sum;
}

PALPATE_INLINE std::ostream& operator<<(std::ostream& out, const SetupReport& r) {
  out << "set-up: " << r.nodes << " nodes, " << r.elements << " elements, " << r.free_dofs
      << " free dofs: " << r.kept_dofs << " kept, " << r.condensed_dofs << " condensed; " << r.touchable_vertices
      << " touchable vertices, " << r.rendered_nodes << " rendered nodes\n"
      << "  memory: stiffness " << number(static_cast<double>(r.stiffness_bytes) / 1e6) << " MB, solver "
      << number(static_cast<double>(r.solver_bytes) / 1e6) << " MB, compliance "
      << number(static_cast<double>(r.compliance_bytes) / 1e6) << " MB\n  time:";
  for (const auto& [stage, seconds] : r.seconds) out << ' ' << stage << ' ' << number(1e3 * seconds) << " ms";
  out << "\n  quality: worst " << number(r.worst_quality) << ", mean " << number(r.mean_quality) << "; condition "
      << (r.condition_estimate > 0.0 ? number(r.condition_estimate) : std::string("not estimated")) << ", probe error "
      << number(r.probe_error) << '\n';
  if (r.column_seconds > 0.0)
    out << "  compliance of a vertex at its first contact: " << number(1e6 * r.column_seconds)
        << (r.asynchronous_columns ? " us, in a background thread\n" : " us, in the tick\n");
  if (r.accuracy.places > 0)
    out << "  force error of a sphere of " << number(1e3 * r.accuracy.radius)
        << " mm, pressed in by an eighth of that: " << number(100.0 * r.accuracy.typical) << " % typically, "
        << number(100.0 * r.accuracy.largest) << " % at most, at " << r.accuracy.places << " places"
        << (r.accuracy.pinched > 0 ? ", " + std::to_string(r.accuracy.pinched) + " of them also pinched" : "")
        << (r.accuracy.remark.empty() ? "" : "; " + r.accuracy.remark) << '\n';
  else if (!r.accuracy.remark.empty())
    out << "  force error: not measured, " << r.accuracy.remark << '\n';
  if (!r.cache.file.empty()) out << "  cache: " << r.cache << '\n';
  for (const auto& [flag, remark] : r.remarks) out << "  note: " << remark << '\n';
  return out;
}

}}  // namespace palpate
