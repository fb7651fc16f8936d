// Definitions of local_contact.hpp.
#pragma once

#include <palpate/contact/detail/candidates.ipp>  // its inline functions
#include <palpate/contact/detail/local_contact.hpp>

#include <algorithm>
#include <cmath>

namespace palpate { inline namespace PALPATE_ABI {

PALPATE_INLINE void LocalContact::start(Tools tools, Candidates& candidates) const noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    ContactTool& tool = tools[t];
    if (!tool.active || tool.grasping || tool.force.squaredNorm() > 0.0 || !candidates.facets().are_coarse(tool))
      continue;
    const Candidate* nearest = nullptr;
    for (const Candidate& c : candidates.items())
      if (c.tool == static_cast<int>(t) &&
          (nearest == nullptr || candidates.least_gap(c) < candidates.least_gap(*nearest)))
        nearest = &c;
    tool.local_compliance = 0.0;
    if (nearest == nullptr || !candidates.is_moving(*nearest)) continue;
    tool.local_compliance =
        LocalIndentation(tool.radius, candidates.facets().at(candidates.sample_of(*nearest))).secant(0.0);
  }
}

PALPATE_INLINE LocalContact::Load LocalContact::load_of(int tool, const ContactTool& own, const Candidates& candidates,
                                                        const ContactRows& rows) noexcept {
  Load load;
  double known = 0.0;
  for (int i = 0; i < rows.count(); ++i) {
    const Candidate& c = rows.candidate(i);
    if (c.tool != tool || c.grasped || !(c.force > 0.0)) continue;
    const FacetScale scale = candidates.facets().at(candidates.sample_of(c));
    load.force += c.force;
    load.facets.length += c.force * scale.length;
    if (scale.material.modulus == 0.0 || own.half_length > 0.0) continue;
    known += c.force;
    load.facets.material.modulus += c.force * scale.material.modulus;
    load.facets.material.poisson_ratio += c.force * scale.material.poisson_ratio;
  }
  if (!(load.force > 0.0)) return load;
  load.facets.length /= load.force;
  if (known > 0.0) {
    load.facets.material.modulus /= known;
    load.facets.material.poisson_ratio /= known;
  }
  load.known = known / load.force;
  return load;
}

PALPATE_INLINE double LocalContact::predict(Tools tools, const Candidates& candidates,
                                            const ContactRows& rows) noexcept {
  double change = 0.0;
  for (std::size_t t = 0; t < tools.size(); ++t) {
    const ContactTool& tool = tools[t];
    Next& next = next_[t];
    next.known = false;
    const double force = tool.force.norm();
    if (!tool.active || !(force > 0.0) || !candidates.facets().are_coarse(tool)) continue;
    next.load = load_of(static_cast<int>(t), tool, candidates, rows);
    if (!(next.load.force > 0.0)) continue;
    next.known = true;
    const double all = std::max(rows.push_work(static_cast<int>(t)) / (force * force), tool.total_compliance());
    next.rest = all - tool.total_compliance();
    next.compliance = tool.local_compliance;
    if (tool.grasping) continue;
    const LocalIndentation law(tool.radius, next.load.facets, next.load.known);
    const double other = all - tool.local_compliance;
    next.compliance = law.secant(law.force_of(other, force * all));
    change = std::max(change, std::abs(next.compliance - tool.local_compliance) / all);
  }
  return change;
}

PALPATE_INLINE void LocalContact::apply(Tools tools) noexcept {
  for (std::size_t t = 0; t < tools.size(); ++t) {
    if (next_[t].known && tools[t].active) tools[t].local_compliance = next_[t].compliance;
    next_[t].known = false;
  }
}

PALPATE_INLINE Status LocalContact::status(std::size_t t, const ContactTool& tool) const noexcept {
  constexpr double mostly = 0.5, negligible = 0.1;
  const auto& [compliance, rest, load, known] = next_[t];
  const double force = tool.force.norm();
  if (!known || !(force > 0.0) || !LocalIndentation::is_coarse(tool.radius, load.facets.length)) return {};
  const bool cancels = force < force_scale(force, load.force);  // the law is for a force on one side
  if (load.known < 1.0 || cancels) return StatusFlag::coarse_contact;
  const LocalIndentation law(tool.radius, load.facets);
  const double indentation = (rest + compliance) * force, local = law.depth(force);
  const double left_out = law.missing(force) - local;
  const bool estimated =
      local > mostly * indentation || left_out > negligible * indentation || law.half_space(force) > tool.radius;
  return estimated ? StatusFlag::coarse_contact : Status{};
}

PALPATE_INLINE bool LocalContact::presses_long_facets(std::size_t t, const ContactTool& tool, double depth,
                                                      const Candidates& candidates, const ContactRows& rows) noexcept {
  constexpr double long_facet = 0.75, usual_depth = 0.125;
  const Load load = load_of(static_cast<int>(t), tool, candidates, rows);
  if (!(load.force > 0.0) || LocalIndentation::is_coarse(tool.radius, load.facets.length)) return false;
  double indentation = depth;  // of the tissue under the tool: the body may bend
  if (load.known == 1.0)
    indentation = std::min(depth, LocalIndentation(tool.radius, load.facets).half_space(tool.force.norm()));
  const double contact = std::sqrt(tool.radius * std::max(indentation, usual_depth * tool.radius));
  return load.facets.length > long_facet * contact;
}

}}  // namespace palpate
