// Definitions of diagnosis.hpp.
#pragma once

#include <palpate/mesh/diagnosis.hpp>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void Finding::add(std::int64_t id, double value, double bound) {
  if (count == 0 || value < worst) {
    worst = value;
    threshold = bound;
  }
  if (ids.size() < SetupProblem::max_ids) {
    ids.push_back(id);
    values.push_back(value);
  }
  ++count;
}

PALPATE_INLINE std::string describe(const MeshDiagnosis& d) {
  std::string text = std::to_string(d.node_count) + " nodes, " + std::to_string(d.element_count) + " elements, " +
                     std::to_string(d.component_count) + " components, volume " + number(d.volume) + " m^3, diagonal " +
                     number(d.diagonal) + " m, quality " + number(d.min_quality) + " least, " + number(d.mean_quality) +
                     " mean";
  const auto line = [&text](const char* name, const Finding& f) {
    if (!f) return;
    text += std::string("\n") + name + ": " + std::to_string(f.count) + ", worst " + number(f.worst);
    if (!f.ids.empty()) text += ", ids";
    for (auto id : f.ids) text += ' ' + std::to_string(id);
    if (!f.ids.empty() && f.count > static_cast<Index>(f.ids.size())) text += " ...";
  };
  line("index out of range", d.index_out_of_range);
  line("not finite", d.non_finite);
  line("inverted", d.inverted);
  line("degenerate", d.degenerate);
  line("poor quality", d.poor_quality);
  line("slivers", d.slivers);
  line("duplicate nodes", d.duplicate_nodes);
  line("duplicate elements", d.duplicate_elements);
  line("orphan nodes", d.orphans);
  line("disconnected, first nodes", d.disconnected);
  line("looks like millimetres", d.units);
  return text;
}

}}  // namespace palpate
