// Laws of physics that every force must follow.
#include "comparisons.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace cross {

using namespace palpate;

namespace {

bool remembers(const Scene& s) {
  return s.law == "viscoelastic";
}
bool grasps(const Scene& s) {
  return std::any_of(s.tools.begin(), s.tools.end(), [](const ToolValue& t) { return t.grasps; });
}
bool all_paths(const Scene& s, std::initializer_list<const char*> allowed) {
  return std::all_of(s.tools.begin(), s.tools.end(), [&](const ToolValue& t) {
    return std::find(allowed.begin(), allowed.end(), t.path) != allowed.end();
  });
}
/// One tool, or a pinch, that presses tissue without loads, as far as the direction of the force follows from the path
/// alone.
bool is_plain_press(const Scene& s) {
  return (s.tools.size() == 1 || is_pinch(s)) && s.tools[0].kind != "blade" && !grasps(s) && s.load == "none" &&
         s.support_moves == 0.0 && s.support_travels == 0.0 && !is_cut(s) && all_paths(s, {"press", "hold"});
}
bool is_one_press(const Scene& s) {
  return s.tools.size() == 1 && is_plain_press(s);
}

/// Flags that excuse a force that pulls or swings, or gives energy. Coarse facets do not cause this, except where the
/// dent within a facet is an estimate.
Status doubts_of_direction(const Scene& s) {
  for (const ToolValue& t : s.tools)
    if (t.radius < 0.6 * s.edge) return doubts();
  Status status;
  for (int bit = 0; bit < status_flag_count; ++bit)
    if (const auto flag = static_cast<StatusFlag>(1u << bit); flag != StatusFlag::coarse_contact && doubts().has(flag))
      status.set(flag);
  return status;
}

std::vector<Finding> check_finite(const Scene&, const Run& r) {
  for (std::size_t k = 0; k < r.ticks.size(); ++k)
    for (std::size_t t = 0; t < r.ticks[k].size(); ++t)
      if (!r.ticks[k][t].finite) return {at("finite", r, static_cast<int>(k), static_cast<int>(t), 0.0, 0.0, {})};
  return {};
}

/// Forces on the tissue and on the tools are equal, except where the solution has not converged.
std::vector<Finding> check_reaction(const Scene& s, const Run& r) {
  for (std::size_t k = 0; k < r.imbalance.size(); ++k)
    if (!(r.imbalance[k] <= 1e-6 * force_scale(s, r.peak)))
      if (Finding f = at("action and reaction", r, static_cast<int>(k), 0, r.imbalance[k], 0.0, excuses()); !f.flagged)
        return {f};
  return {};
}

/// The ticks of one tool whose values fail; the first silent one, or the first.
template <class Fails>
std::vector<Finding> first_failure(const char* name, const Run& r, int from, int to, std::size_t tool, Fails&& fails,
                                   Status excuse = doubts()) {
  std::vector<Finding> findings;
  for (int k = std::max(from, 0); k < std::min<int>(to, static_cast<int>(r.ticks.size())); ++k) {
    double found = 0.0, expected = 0.0;
    if (!fails(k, found, expected)) continue;
    findings.push_back(at(name, r, k, static_cast<int>(tool), found, expected, excuse));
    if (!findings.back().flagged) return {findings.back()};
  }
  if (findings.size() > 1) findings.resize(1);
  return findings;
}

/// A tool is pushed out of the tissue, never pulled in.
std::vector<Finding> check_pull(const Scene& s, const Run& r) {
  std::vector<Finding> findings;
  for (std::size_t t = 0; t < s.tools.size() && findings.empty(); ++t) {
    const Vector3 out = place_of(s, s.tools[t].u, s.tools[t].v, s.tools[t].opposite).normal;
    findings = first_failure(
        "no pull", r, 0, static_cast<int>(r.ticks.size()), t,
        [&](int k, double& found, double&) {
          found = r.ticks[static_cast<std::size_t>(k)][t].force.dot(out);
          return found < -0.02 * force_scale(s, r.peak);
        },
        doubts_of_direction(s));
  }
  return findings;
}

/// The force grows while the tool goes in. Between the steps of tissue that moves it is that of the last tangent.
std::vector<Finding> check_monotone(const Scene& s, const Run& r) {
  const Vector3 out = place_of(s, s.tools[0].u, s.tools[0].v, s.tools[0].opposite).normal;
  double most = 0.0;
  return first_failure("grows with depth", r, 0, first_hold(s), 0, [&](int k, double& found, double& expected) {
    found = r.ticks[static_cast<std::size_t>(k)][0].force.dot(out);
    most = std::max(most, found), expected = most;
    return found < most - (moves(s.solver) ? 0.05 : 0.03) * force_scale(s, r.peak);
  });
}

/// How far a body's facets and inner jitter may be from the surface of its formula [m].
double surface_margin(const Scene& s) {
  return s.body == "block" || s.body == "plate" || s.body == "lobe" ? 1e-6 : 0.4 * s.edge;
}

/// A tool that stays inside the tissue is pushed.
std::vector<Finding> check_lost(const Scene& s, const Run& r) {
  std::vector<Finding> findings;
  for (std::size_t i = 0; i < s.tools.size() && findings.empty(); ++i)
    findings =
        first_failure("not lost", r, first_hold(s), last_hold(s), i, [&](int k, double& found, double& expected) {
          const ToolTick& t = r.ticks[static_cast<std::size_t>(k)][i];
          const double radius = s.tools[i].radius;
          found = t.force.norm(), expected = 0.02 * s.youngs_modulus * t.depth * std::sqrt(radius * t.depth);
          return t.depth > 0.1 * radius && t.depth > 0.02 * s.edge + surface_margin(s) && found < 0.01 * expected;
        });
  return findings;
}

/// There is no force before the tool touches.
std::vector<Finding> check_free(const Scene& s, const Run& r) {
  for (std::size_t t = 0; t < s.tools.size(); ++t) {
    const double margin = surface_margin(s);
    auto found = first_failure("no force in the air", r, 0, first_hold(s), t, [&](int k, double& f, double&) {
      const ToolTick& tick = r.ticks[static_cast<std::size_t>(k)][t];
      f = tick.force.norm();
      return tick.depth < -margin && f > 1e-3 * force_scale(s, r.peak);
    });
    if (!found.empty()) return found;
  }
  return {};
}

/// A closed path gives no energy to the hands; without friction and memory the tissue keeps none either.
std::vector<Finding> check_work(const Scene& s, const Run& r) {
  const double tolerance = (moves(s.solver) ? 0.05 : 0.02) * r.work_in + 1e-9;
  const bool elastic = s.friction == 0.0 && !has_inertia(s) && !remembers(s) && !is_cut(s) && !grasps(s) &&
                       !moves(s.solver) && all_paths(s, {"press", "hold"});
  if (r.work >= -tolerance && (!elastic || r.work <= 3.0 * tolerance)) return {};
  Status seen;
  for (const auto& tick : r.ticks)
    for (const ToolTick& t : tick) seen |= t.status;
  Finding f = at("work of a closed path", r, static_cast<int>(r.ticks.size()) - 1, 0, r.work, r.work_in,
                 doubts_of_direction(s));
  f.flagged = f.flagged || (seen.bits() & doubts_of_direction(s).bits()) != 0;
  return {f};
}

/// A tool that stays at its place has a force that does not swing.
std::vector<Finding> check_settled(const Scene& s, const Run& r) {
  if (r.ticks.empty()) return {};
  const int from = (2 * first_hold(s) + 3 * last_hold(s)) / 5, to = last_hold(s);
  for (std::size_t t = 0; t < s.tools.size(); ++t) {
    // What it falls and rises again, or rises and falls again; a force that only creeps has none of one of the two.
    Vector3 mean = Vector3::Zero();
    for (int k = from; k < to; ++k) mean += r.ticks[static_cast<std::size_t>(k)][t].force;
    if (mean.squaredNorm() == 0.0) continue;
    const Vector3 direction = mean.normalized();
    double most = -std::numeric_limits<double>::infinity(), least = -most, falls = 0.0, rises = 0.0;
    int worst = from;
    for (int k = from; k < to; ++k) {
      const double f = r.ticks[static_cast<std::size_t>(k)][t].force.dot(direction);
      most = std::max(most, f), least = std::min(least, f);
      if (std::max(most - f, f - least) > std::max(falls, rises)) worst = k;
      falls = std::max(falls, most - f), rises = std::max(rises, f - least);
    }
    if (const double swing = std::min(falls, rises); swing > 0.02 * force_scale(s, r.peak))
      return {at("settles", r, worst, static_cast<int>(t), swing, r.peak, doubts_of_direction(s))};
  }
  return {};
}

/// No vertex of the surface is inside a sphere, if facets are no longer than its radius. Displayed vertices lack the
/// dent within a facet: up to 9 % of the radius was measured.
std::vector<Finding> check_penetration(const Scene& s, const Run& r) {
  double smallest = std::numeric_limits<double>::infinity();
  for (const ToolValue& t : s.tools) smallest = std::min(smallest, t.radius);
  if (!(r.penetration > 0.1 * smallest)) return {};
  return {at("no penetration", r, last_hold(s) - 1, 0, r.penetration, 0.0, doubts())};
}

/// Elastic tissue is where it was when nothing presses any more.
std::vector<Finding> check_back(const Scene& s, const Run& r) {
  if (r.ticks.empty()) return {};
  const bool presses = std::any_of(r.ticks.back().begin(), r.ticks.back().end(),
                                   [](const ToolTick& t) { return t.force.squaredNorm() > 0.0; });
  if (presses || !(r.left > 0.05 * s.edge)) return {};
  return {at("comes back", r, static_cast<int>(r.ticks.size()) - 1, 0, r.left, 0.0, excuses())};
}

/// A tick of tissue at rest whose force is that of the tick before has converged.
std::vector<Finding> check_converged(const Scene& s, const Run& r) {
  const int to = last_hold(s), from = to - 10;
  for (std::size_t t = 0; t < s.tools.size(); ++t) {
    bool still = r.peak > 0.0;
    for (int k = from; k < to && still; ++k) {
      const ToolTick &a = r.ticks[static_cast<std::size_t>(k)][t], &b = r.ticks[static_cast<std::size_t>(k - 1)][t];
      still = a.status.has(StatusFlag::solver_not_converged) && a.proxy.isApprox(b.proxy, 1e-9) &&
              (a.force - b.force).norm() < 1e-6 * force_scale(s, r.peak);
    }
    if (still) return {at("still but not converged", r, to - 1, static_cast<int>(t), 1.0, 0.0, {})};
  }
  return {};
}

/// The report of the set-up has the memory.
std::vector<Finding> check_report(const Scene&, const Run& r) {
  if (r.has_report) return {};
  return {{"report", 0, 0, 0.0, 1.0, false, ""}};
}

}  // namespace

const std::vector<Oracle>& laws_of_physics() {
  static const std::vector<Oracle> all{
      {"finite", 0, [](const Scene&) { return true; }, check_finite},
      {"action and reaction", 0, [](const Scene&) { return true; }, check_reaction},
      // A tool that sticks in its dent is also drawn back.
      {"no pull", 0, [](const Scene& s) { return is_plain_press(s) && !has_inertia(s) && s.friction == 0.0; },
       check_pull},
      {"grows with depth", 0,
       [](const Scene& s) { return is_one_press(s) && !has_inertia(s) && !remembers(s) && s.friction == 0.0; },
       check_monotone},
      {"not lost", 0, [](const Scene& s) { return is_plain_press(s) && !has_inertia(s); }, check_lost},
      {"no force in the air", 0,
       [](const Scene& s) {
         return s.load == "none" && s.support_moves == 0.0 && s.support_travels == 0.0 && s.tools.size() == 1 &&
                !is_cut(s) && s.jitter == 0.0 && !s.tools[0].opposite;
       },
       check_free},
      {"work of a closed path", 0,
       [](const Scene& s) {
         return all_paths(s, {"press", "hold", "slide"}) && s.cuts == 0 && s.load == "none" && s.support_moves == 0.0 &&
                s.support_travels == 0.0;
       },
       check_work},
      {"settles", 0,
       [](const Scene& s) {
         return all_paths(s, {"press", "hold"}) && !has_inertia(s) && !is_cut(s) && s.support_travels == 0.0;
       },
       check_settled},
      {"comes back", 0,
       [](const Scene& s) { return moves(s.solver) && !has_inertia(s) && !remembers(s) && !is_cut(s) && !grasps(s); },
       check_back},
      {"still but not converged", 0,
       [](const Scene& s) {
         return !moves(s.solver) && !is_cut(s) && all_paths(s, {"press", "hold"});
       },
       check_converged},
      {"report", 0, [](const Scene&) { return true; }, check_report},
      {"no penetration", 0,
       [](const Scene& s) {
         return all_paths(s, {"press", "hold"}) && !is_cut(s) && !grasps(s) && !has_inertia(s);
       },
       check_penetration},
  };
  return all;
}

}  // namespace cross
