// Summary of a run for documents.
#include <fstream>
#include <set>
#include <sstream>

#include "page.hpp"

namespace tradeoff {
namespace {

void add_line(std::ostream& out, const Row& r) {
  const auto code = [](const std::string& s) { return s.find('<') == s.npos ? s : '`' + s + '`'; };
  out << "| " << code(r.element) << ", " << r.kinematics << ", " << code(r.solver);
  for (const std::string* part : {&r.kept, &r.work})
    if (!part->empty()) out << ", " << *part;
  out << " | " << r.mesh << " | " << three_digits(1e3 * r.setup) << " | " << three_digits(1e6 * r.p99) << ", "
      << three_digits(1e6 * r.worst) << " | " << (r.update_p99 > 0.0 ? three_digits(1e3 * r.update_p99) : "") << " | "
      << three_digits(100.0 * r.force_small) << " | " << three_digits(100.0 * r.force_large) << " | "
      << three_digits(100.0 * r.in_motion) << " | " << three_digits(100.0 * r.moved_large) << " | "
      << three_digits(100.0 * r.volume_large) << " | "
      << r.verdict + (r.verdict.empty() || r.remark.empty() ? "" : "; ") + r.remark << " |\n";
}

}  // namespace

std::string summary(const Bench& bench, const std::vector<Row>& rows, double budget) {
  const PressScene& s = bench.scene;
  const Reference& ref = bench.reference;
  std::ostringstream out;
  out << "Written by `sh cmake/run tradeoff --scene " << s.name << " --budget-us " << three_digits(1e6 * budget)
      << " --docs`: " << rows.size() << " rows; spheres of " << three_digits(2e3 * s.radius) << " mm at "
      << three_digits(1e3 * s.small) << " and " << three_digits(1e3 * s.large) << " mm; reference of " << ref.nodes
      << " nodes, " << three_digits(ref.force(0, s.small).norm()) << " and "
      << three_digits(ref.force(0, s.large).norm()) << " N, relative error "
      << three_digits(100.0 * ref.mesh_error_small) << " and " << three_digits(100.0 * ref.mesh_error_large)
      << " %.\n\n![Force error in motion over the p99 of a tick](tradeoff-" << s.name << ".svg)\n\n```cpp\n"
      << advice(rows, budget) << "```\n\n"
      << "| composition | mesh | set-up [ms] | tick p99, worst [us] | update p99 [ms] | force small [%] | large [%] "
      << "| in motion [%] | moved large [%] | volume large [%] | remark "
         "|\n|---|---|---|---|---|---|---|---|---|---|---|\n";
  std::set<std::string> shown;
  for (const auto& [title, error] : measures)
    for (const MeasuredComposition& m : trade_off_of(rows, error, true).front()) shown.insert(m.name);
  for (const Row& r : rows)
    if (shown.contains(r.name()) || r.family == "baseline") add_line(out, r);
  return out.str();
}

}  // namespace tradeoff
