// The same scene in another manner gives the same force.
#include "comparisons.hpp"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <limits>
#include <numbers>

namespace cross {

using namespace palpate;

namespace {

Matrix3 rotation() {
  return Eigen::AngleAxisd(2.1, Vector3(0.3, -1.0, 0.5).normalized()).toRotationMatrix();
}
Matrix3 reflection() {
  return Vector3(1.0, -1.0, 1.0).asDiagonal();
}

bool is_static(const Scene& s) {
  return !moves(s.solver) && !can_be_cut(s.solver);
}
/// Whether a run repeats to the last bit: not where a thread renews the factor of tissue that is cut.
bool repeats_exactly(const Scene& s) {
  return !can_be_cut(s.solver) || !is_cut(s);
}
double exactly(const Scene& s) {
  return repeats_exactly(s) ? 0.0 : 0.02;
}
double almost_exactly(const Scene& s) {
  return repeats_exactly(s) ? 1e-9 : 0.02;
}

/// The same for a second play on the same tissue. A solver that keeps some columns of the compliance may have replaced
/// some: that changes forces by rounding, or by the tolerance of an iterative solver.
double replayed(const Scene& s) {
  const bool keeps_columns = is_static(s) && s.solver != "condensed" && s.solver != "condensed_float" &&
                             s.solver != "inverse" && s.solver != "stiffening";
  return keeps_columns ? 1e-5 : exactly(s);
}

/// Relative difference up to which two runs whose rounding differs are equal. A tick ends when its force changes by a
/// thousandth, not by rounding. Friction and motion remember: where a contact begins a tick later, the forces after it
/// differ.
double rounding_tolerance(const Scene& scene) {
  return moves(scene.solver) || scene.friction > 0.0 ? 0.05 : has_float(scene.solver) ? 0.02 : 0.01;
}

/// Whether the digits of the solver did not suffice.
bool is_refused_for_rounding(const Run& run) {
  return run.refused == "ill_conditioned" || run.refused == "not_positive_definite";
}

std::vector<Finding> compare_with(const char* name, const Scene& scene, const Run& run, const Manner& manner,
                                  double tolerance) {
  return compare(name, scene, run, cross::run(scene, manner), tolerance);
}

/// The run with means of forces and torques over 11 ticks.
Run without_vibration(const Run& run) {
  constexpr std::size_t around = 5;
  Run mean = run;
  for (std::size_t k = 0; k < run.ticks.size(); ++k) {
    const std::size_t first = k < around ? 0 : k - around, last = std::min(k + around, run.ticks.size() - 1);
    for (std::size_t t = 0; t < run.ticks[k].size(); ++t) {
      ToolTick& m = mean.ticks[k][t];
      m.force.setZero(), m.torque.setZero();
      for (std::size_t i = first; i <= last; ++i) m.force += run.ticks[i][t].force, m.torque += run.ticks[i][t].torque;
      m.force /= static_cast<double>(last - first + 1), m.torque /= static_cast<double>(last - first + 1);
    }
  }
  return mean;
}

/// For manners in which other points of the surface press: within the bound that both runs state for it, up to a
/// twentieth, or a fifth on a support, which yields nowhere: a tool sinks in between its points. They let a body
/// vibrate in another way, where it can. The flag coarse_contact reports errors of a tenth, and more, of each of the
/// two.
std::vector<Finding> compare_with_other_points(const char* name, const Scene& scene, const Run& run,
                                               const Manner& manner, double tolerance) {
  const Run other = cross::run(scene, manner);
  const double most = presses_support(scene) ? 0.2 : 0.05;
  std::vector<Finding> found =
      has_inertia(scene) ? compare(name, scene, without_vibration(run), without_vibration(other), tolerance, most)
                         : compare(name, scene, run, other, tolerance, most);
  constexpr double coarse = 0.2;
  for (Finding& f : found)
    if (f.flags.find("CoarseContact") != std::string::npos)
      f.flagged = f.flagged || std::abs(f.found - f.expected) <= coarse * std::max(f.found, f.expected);
  return found;
}

/// Gravity keeps its direction in the world when the pose rotates the body.
bool has_free_direction(const Scene& s) {
  return s.load != "gravity" || s.pose == "identity";
}
bool always(const Scene&) {
  return true;
}
bool is_alone(const Scene& s) {
  return s.member == "alone";
}

std::vector<Finding> check_repeated(const Scene& s, const Run& r) {
  return compare_with("repeated", s, r, {}, exactly(s));
}
std::vector<Finding> check_again(const Scene& s, const Run& r) {
  return compare_with("played again", s, r, {.plays = 2}, replayed(s));
}
std::vector<Finding> check_new_servo(const Scene& s, const Run& r) {
  return compare_with("new servo", s, r, {.plays = 2, .new_servo = true}, replayed(s));
}
std::vector<Finding> check_moved(const Scene& s, const Run& r) {
  return compare_with("other pose", s, r, {.pose = s.pose == "identity" ? "rotated" : "identity"},
                      rounding_tolerance(s));
}
std::vector<Finding> check_shifted(const Scene& s, const Run& r) {
  return compare_with("shifted", s, r, {.change = {.shift = {0.11, -0.07, 0.05}}}, rounding_tolerance(s));
}
std::vector<Finding> check_rotated(const Scene& s, const Run& r) {
  return compare_with("rotated", s, r, {.change = {.linear = rotation()}}, rounding_tolerance(s));
}
std::vector<Finding> check_mirrored(const Scene& s, const Run& r) {
  return compare_with_other_points("mirrored", s, r, {.change = {.linear = reflection()}}, rounding_tolerance(s));
}
std::vector<Finding> check_scaled(const Scene& s, const Run& r) {
  return compare_with("scaled", s, r, {.change = {.scale = 1.7}}, rounding_tolerance(s));
}
std::vector<Finding> check_renumbered(const Scene& s, const Run& r) {
  constexpr double other_points = 0.06;  // the choice of contact points depends on the numbers of the vertices
  return compare_with_other_points("renumbered", s, r, {.change = {.renumbered = true}},
                                   std::max(rounding_tolerance(s), other_points));
}
std::vector<Finding> check_split(const Scene& s, const Run& r) {
  return compare_with("two equal regions", s, r, {.change = {.split = true}}, rounding_tolerance(s));
}
std::vector<Finding> check_group(const Scene& s, const Run& r) {
  return compare_with("group of one", s, r, {.member = "group"}, exactly(s));
}
std::vector<Finding> check_pair(const Scene& s, const Run& r) {
  return compare_with("group of two", s, r, {.member = "pair"}, exactly(s));
}
std::vector<Finding> check_adaptor(const Scene& s, const Run& r) {
  return compare_with("adaptor", s, r, {.member = "adaptor"}, exactly(s));
}
std::vector<Finding> check_threads(const Scene& s, const Run& r) {
  return compare_with("three threads", s, r, {.threads = s.threads == 1 ? 3 : 1}, almost_exactly(s));
}
std::vector<Finding> check_cache(const Scene& s, const Run& r) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("palpate_cross_" + std::to_string(getpid()))).string();
  (void)cross::run(s, {.cache_file = file});
  const Run read = cross::run(s, {.cache_file = file});
  std::remove(file.c_str());
  return compare("read from a cache", s, r, read, 0.0);
}
/// The solver of double precision that solves the same equations.
std::string twin_of(const std::string& solver) {
  if (solver == "condensed_float") return "condensed";
  if (solver == "quasi_newton_float") return "quasi_newton";
  if (solver == "cut_quasi_newton_float") return "cut_quasi_newton";
  return {};
}
bool has_twin(const Scene& s) {
  return !twin_of(s.solver).empty() && find_composition(s.element, s.law, twin_of(s.solver)) != nullptr;
}
std::vector<Finding> check_double(const Scene& s, const Run& r) {
  if (is_refused_for_rounding(r)) return {};  // its precision may be too small
  return compare_with("double precision", s, r, {.solver = twin_of(s.solver)}, std::max(0.02, rounding_tolerance(s)));
}
bool has_other_static(const Scene& s) {
  return is_static(s) && s.law == "linear" && s.solver != "stiffening" && s.solver != "sparse_cholesky";
}
std::vector<Finding> check_sparse(const Scene& s, const Run& r) {
  if (has_float(s.solver) && !r.refused.empty()) return {};  // its precision may be too small
  return compare_with("sparse factorisation", s, r, {.solver = "sparse_cholesky"}, 0.01);
}
/// Before the first cut, tissue that can be cut is that of the inner solver.
bool is_uncut(const Scene& s) {
  return can_be_cut(s.solver) && !is_cut(s) && find_composition(s.element, s.law, s.solver.substr(4)) != nullptr;
}
std::vector<Finding> check_uncut(const Scene& s, const Run& r) {
  return compare_with("not cuttable", s, r, {.solver = s.solver.substr(4)}, rounding_tolerance(s));
}
std::vector<Finding> check_all_rows(const Scene& s, const Run& r) {
  return compare_with_other_points("all contacts", s, r, {.capacity = 1000}, 0.05);
}
/// Newton's method in every step, for tissue without inertia that has come to rest.
bool has_newton(const Scene& s) {
  return s.solver.starts_with("quasi_newton") && find_composition(s.element, s.law, "newton") != nullptr;
}
std::vector<Finding> check_newton(const Scene& s, const Run& r) {
  const Run other = cross::run(s, {.solver = "newton"});
  return compare_at_rest("Newton's method", s, r, other, 0.05);
}
/// A press of tissue without memory that takes longer ends with the same force.
bool ends_at_rest(const Scene& s) {
  return !has_inertia(s) && !is_cut(s) && s.law != "viscoelastic" && s.support_travels == 0.0 &&
         std::all_of(s.tools.begin(), s.tools.end(),
                     [](const ToolValue& t) { return t.path == "press" || t.path == "hold"; });
}
std::vector<Finding> check_longer(const Scene& s, const Run& r) {
  const Change longer{.pause = 0.2};
  return compare_at_rest("longer press", s, r, cross::run(s, {.change = longer}), 0.05, longer);
}
bool has_work(const Scene& s) {
  return moves(s.solver) && s.step >= 0.005 && s.support_travels == 0.0;
}
/// A body load is gravity of the same force, in every element, also in one that is cut.
std::vector<Finding> check_gravity(const Scene& s, const Run& r) {
  return compare_with("gravity in its place", s, r, {.change = {.gravity = true}}, rounding_tolerance(s));
}
/// A second servo whose tools are in the air is refused, or changes nothing.
std::vector<Finding> check_second_servo(const Scene& s, const Run& r) {
  const Run other = cross::run(s, {.second_servo = true});
  if (!other.refused.empty()) return {};
  return compare("second servo", s, r, other, exactly(s));
}
/// A recording has the forces that were rendered, and replays to the same ones.
std::vector<Finding> check_recording(const Scene& s, const Run& r) {
  const std::string file =
      (std::filesystem::temp_directory_path() / ("palpate_cross_" + std::to_string(getpid()) + ".csv")).string();
  const Run replayed_run = cross::run(s, {.cache_file = file, .plays = 2, .recorded = true});
  std::remove(file.c_str());
  if (r.refused.empty() && replayed_run.misrecorded >= 0) {
    const Vector3& force = r.ticks[static_cast<std::size_t>(replayed_run.misrecorded)][0].rendered;
    return {at("recording", r, replayed_run.misrecorded, 0, 0.0, force.norm(), {})};
  }
  return compare("recording", s, r, replayed_run, replayed(s));
}
/// How many times its force without friction a press may have with it: half as much again, or what holds the tissue on
/// the flanks of a sphere or capsule. In a deep press these are up to 60 degrees steep (docs/contact.md), and a force N
/// on one adds N (cos + friction sin) to the press. At 1.25 radii a pinch had 2.1 times its force, one tool 1.8 times,
/// the same on facets half as long.
double most_by_friction(const Scene& s, const ToolValue& t) {
  const double cosine = 1.0 - std::min(t.depth, 0.5), usual = 1.5;
  if (t.kind == "plate") return usual;
  return std::max(usual, 1.0 + s.friction * std::sqrt(1.0 - cosine * cosine) / cosine);
}
/// Friction changes the force of a press, unless it is deep, by less than a half of it. Not at an edge, or on a round
/// body: there the tissue slips aside.
bool can_slip(const Scene& s) {
  const auto is_inside = [&](const ToolValue& t) {
    const double x = std::min(t.u, 1.0 - t.u) * s.edge * s.cells_x, y = std::min(t.v, 1.0 - t.v) * s.edge * s.cells_y;
    return std::min(x, y) > t.radius * (is_pinch(s) ? std::sqrt(t.depth) : 1.0);
  };
  if (!is_box(s) || !std::all_of(s.tools.begin(), s.tools.end(), is_inside)) return false;
  return s.friction > 0.0 && !has_inertia(s) && !is_cut(s) && s.load == "none" && s.support_moves == 0.0 &&
         s.support_travels == 0.0 && std::all_of(s.tools.begin(), s.tools.end(), [](const ToolValue& t) {
           return (t.path == "press" || t.path == "hold") && !t.grasps;
         });
}
std::vector<Finding> check_frictionless(const Scene& s, const Run& r) {
  const Run other = cross::run(s, {.frictionless = true});
  if (!r.refused.empty() || !other.refused.empty()) return {};
  const int tick = last_hold(s) - 2;
  for (std::size_t t = 0; t < s.tools.size(); ++t) {
    const Vector3 normal = place_of(s, s.tools[t].u, s.tools[t].v, s.tools[t].opposite).normal;
    const double with = r.ticks[static_cast<std::size_t>(tick)][t].force.dot(normal),
                 without = other.ticks[static_cast<std::size_t>(tick)][t].force.dot(normal);
    const bool is_usual = with > 0.5 * without && with < most_by_friction(s, s.tools[t]) * without;
    if (without < 0.1 * force_scale(s, other.peak) || is_usual) continue;
    Finding f = at("without friction", r, tick, static_cast<int>(t), with, without, excuses());
    f.flagged = f.flagged || at("without friction", other, tick, 0, 0.0, 0.0, excuses()).flagged;
    return {f};
  }
  return {};
}
/// What is flagged with every contact is flagged with few, too.
std::vector<Finding> check_warnings(const Scene& s, const Run& r) {
  const Run other = cross::run(s, {.capacity = 1000});
  if (!r.refused.empty() || !other.refused.empty()) return {};
  const auto warns = [](const Run& run, std::size_t k, std::size_t t) {
    return run.ticks[k][t].status.has(StatusFlag::large_displacement);
  };
  for (std::size_t t = 0; t < s.tools.size(); ++t)
    for (std::size_t k = 10, missing = 0; k + 10 < r.ticks.size(); ++k) {
      bool any = false;
      for (std::size_t i = k - 10; i <= k + 10; ++i) any = any || warns(r, i, t);
      missing = warns(other, k, t) && !any ? missing + 1 : 0;
      if (missing < 10) continue;
      Finding f = at("same warning", r, static_cast<int>(k), static_cast<int>(t), 0.0, 1.0, {});
      return {f};
    }
  return {};
}
/// A tissue is not refused because its loads cannot be carried where steps with loads that grow carry them.
bool has_loads_in_steps(const Scene& s) {
  return s.solver.starts_with("quasi_newton") && s.load != "none" && s.support_travels == 0.0;
}
std::vector<Finding> check_refused(const Scene& s, const Run& r) {
  if (r.refused != "not_converged") return {};
  const Run other = cross::run(s, {.loaded_later = true});
  if (!other.refused.empty()) return {};
  Finding f = at("refused in vain", other, static_cast<int>(other.ticks.size()) - 1, 0, 1.0, 0.0, excuses());
  if (f.flagged) return {};
  return {f};
}
std::vector<Finding> check_worker(const Scene& s, const Run& r) {
  return compare_at_rest("worker", s, r, cross::run(s, {.worker = true}), 0.05);
}

}  // namespace

bool has_inertia(const Scene& s) {
  return moves(s.solver) && (s.inertia || s.solver.find("quasi_newton") == std::string::npos);
}

bool is_pinch(const Scene& s) {
  return s.tools.size() == 2 && has_opposite(s) && s.tools[0].opposite != s.tools[1].opposite &&
         s.tools[0].u == s.tools[1].u && s.tools[0].v == s.tools[1].v;
}

bool is_box(const Scene& s) {
  return s.body == "block" || s.body == "plate" || s.body == "lobe";
}

Status excuses() {
  Status s;
  for (const StatusFlag f :
       {StatusFlag::inverted, StatusFlag::solver_not_converged, StatusFlag::degraded_model, StatusFlag::lost_contact,
        StatusFlag::reacquired, StatusFlag::material_exceeded, StatusFlag::energy_grew, StatusFlag::step_refused,
        StatusFlag::non_finite_force, StatusFlag::stalled_tissue})
    s.set(f);
  return s;
}

double force_scale(const Scene& scene, double peak) {
  return std::max(peak, 1e-4 * scene.youngs_modulus * scene.edge * scene.edge);
}

Finding at(const char* oracle, const Run& run, int tick, int tool, double found, double expected, Status excuse) {
  Finding f{oracle, tick, tool, found, expected};
  // A flag of the ticks shortly before counts: a tissue that moves has the force of its last step.
  Status seen;
  for (int k = std::max(0, tick - 20); k <= std::min<int>(tick + 5, static_cast<int>(run.ticks.size()) - 1); ++k)
    for (const ToolTick& t : run.ticks[static_cast<std::size_t>(k)]) seen |= t.status;
  for (int bit = 0; bit < status_flag_count; ++bit) {
    const StatusFlag flag = static_cast<StatusFlag>(1u << bit);
    if (!seen.has(flag)) continue;
    f.flags += (f.flags.empty() ? "" : " ") + std::string(status_flag_name(bit));
    f.flagged = f.flagged || excuse.has(flag);
  }
  return f;
}

namespace {

/// Difference of a force, or of a torque divided by `arm` [m], from that of another run in the same tick, or one tick
/// before or after: a contact or a cut may begin a tick later.
double difference(const Run& run, const Run& other, std::size_t k, std::size_t t, double arm) {
  double least = std::numeric_limits<double>::infinity();
  const ToolTick& a = run.ticks[k][t];
  for (std::size_t i = k == 0 ? 0 : k - 1; i <= std::min(k + 1, other.ticks.size() - 1); ++i) {
    const ToolTick& b = other.ticks[i][t];
    least = std::min(least, std::max((a.force - b.force).norm(), (a.torque - b.torque).norm() / arm));
  }
  return least;
}
bool is_equal(const ToolTick& a, const ToolTick& b) {
  return a.force == b.force && a.torque == b.torque && a.rendered == b.rendered && a.status == b.status &&
         a.bound == b.bound;
}

/// Whether stiffnesses are so different that rounding, and the factorisation, decide whether the digits suffice.
bool is_ill_conditioned(const Scene& s) {
  return std::max(s.contrast, 1.0 / s.contrast) / (1.0 - 2.0 * s.poisson_ratio) > 1e8;
}

bool is_free(const std::vector<ToolTick>& tick) {
  return std::all_of(tick.begin(), tick.end(), [](const ToolTick& t) { return t.force.squaredNorm() == 0.0; });
}

}  // namespace

bool presses_support(const Scene& s) {
  if (s.support == "bottom" || !is_box(s)) return false;
  const double length = s.cells_x * s.edge;
  return std::any_of(s.tools.begin(), s.tools.end(), [&](const ToolValue& t) {
    const double reach = ((t.kind == "sphere" ? 1.0 : 3.0) + t.travel) * t.radius;
    const double from_end = (0.5 + 0.8 * (t.u - 0.5)) * length;  // bodies.cpp avoids edges
    return from_end < reach || (s.support == "sides" && length - from_end < reach);
  });
}

std::vector<Finding> compare(const char* name, const Scene& scene, const Run& run, const Run& other, double tolerance,
                             double most_of_points) {
  // Whether single precision is enough is measured, and refused with a hint.
  const bool is_too_coarse = run.refused == "unsupported" || other.refused == "unsupported";
  if (tolerance > 0.0 && has_float(scene.solver) && is_too_coarse) return {};
  const int for_rounding = is_refused_for_rounding(run) + is_refused_for_rounding(other);
  if (tolerance > 0.0 && (for_rounding == 2 || (for_rounding == 1 && is_ill_conditioned(scene)))) return {};
  if (run.refused != other.refused)
    return {{name, 0, 0, run.refused.empty() ? 0.0 : 1.0, other.refused.empty() ? 0.0 : 1.0, false,
             run.refused + "/" + other.refused}};
  const double scale = force_scale(scene, std::max(run.peak, other.peak));
  std::vector<Finding> findings;
  const std::size_t ticks = std::min(run.ticks.size(), other.ticks.size());
  // After a difference that a flag reports, contacts differ until nothing presses any more, and a tissue that moves
  // also swings differently afterwards: there small differences grow, as a tick may be wrong by a thousandth.
  const bool remembers = moves(scene.solver);
  bool has_diverged = false;
  for (std::size_t k = 0; k < ticks; ++k) {
    if (has_diverged && !remembers && is_free(run.ticks[k]) && is_free(other.ticks[k])) has_diverged = false;
    for (std::size_t t = 0; t < run.ticks[k].size(); ++t) {
      const ToolTick &a = run.ticks[k][t], &b = other.ticks[k][t];
      const double arm = 3.0 * scene.tools[t].radius;  // of the ends of a capsule
      const double apart = tolerance > 0.0 ? difference(run, other, k, t, arm) : 0.0;
      const int tick = static_cast<int>(k), tool = static_cast<int>(t);
      const bool is_flagged = ((a.status.bits() | b.status.bits()) & excuses().bits()) != 0;
      has_diverged = has_diverged || (remembers && is_flagged && apart > 1e-3 * scale);
      const double of_points = std::min(most_of_points * scale, a.of_points + b.of_points);
      const bool same = tolerance > 0.0 ? apart <= tolerance * scale + of_points : is_equal(a, b);
      if (same) continue;
      Finding f = at(name, run, tick, tool, a.force.norm(), b.force.norm(), excuses());
      f.flagged =
          tolerance > 0.0 && (has_diverged || f.flagged || at(name, other, tick, tool, 0.0, 0.0, excuses()).flagged);
      has_diverged = f.flagged;
      if (tolerance == 0.0 && a.force == b.force)
        f.flags += " torques, rendered forces, flags or bounds differ";
      else if ((a.force - b.force).norm() < 0.5 * apart)
        f.of_torques = true, f.found = a.torque.norm(), f.expected = b.torque.norm();
      findings.push_back(f);
      if (!f.flagged) return findings;
    }
  }
  return findings;
}

std::vector<Finding> compare_at_rest(const char* name, const Scene& scene, const Run& run, const Run& other,
                                     double tolerance, const Change& change) {
  if (run.refused != other.refused || !run.refused.empty()) return {};
  const int own = last_hold(scene) - 2, later = last_hold(scene, change) - 2;
  const double scale = force_scale(scene, std::max(run.peak, other.peak));
  for (std::size_t t = 0; t < scene.tools.size(); ++t) {
    const Vector3 &a = run.ticks[static_cast<std::size_t>(own)][t].force,
                  &b = other.ticks[static_cast<std::size_t>(later)][t].force;
    if ((a - b).norm() <= tolerance * scale) continue;
    Finding f = at(name, run, own, static_cast<int>(t), a.norm(), b.norm(), excuses());
    f.flagged = f.flagged || at(name, other, later, 0, 0.0, 0.0, excuses()).flagged;
    return {f};
  }
  return {};
}

const std::vector<Oracle>& comparisons() {
  static const std::vector<Oracle> all{
      {"repeated", 1, always, check_repeated},
      {"played again", 2, always, check_again},
      {"new servo", 2, always, check_new_servo},
      {"other pose", 1, [](const Scene& s) { return s.load != "gravity"; }, check_moved},
      {"shifted", 1, always, check_shifted},
      {"rotated", 1, has_free_direction, check_rotated},
      // Faces of hexahedra are divided along a diagonal, their mirror images along the other one.
      {"mirrored", 1, [](const Scene& s) { return !is_hexahedral(s) && has_free_direction(s); }, check_mirrored},
      {"scaled", 1, [](const Scene& s) { return s.cuts == 0; }, check_scaled},
      {"renumbered", 1, always, check_renumbered},
      {"two equal regions", 1, [](const Scene& s) { return s.regions == "one" && s.element != "smoothed_tet4"; },
       check_split},
      {"group of one", 1, is_alone, check_group},
      {"group of two", 2, is_alone, check_pair},
      {"adaptor", 1, is_alone, check_adaptor},
      {"three threads", 1, always, check_threads},
      {"read from a cache", 2,
       [](const Scene& s) { return s.solver == "condensed" || s.solver == "sparse_cholesky" || s.solver == "inverse"; },
       check_cache},
      {"double precision", 0.5, has_twin, check_double},
      {"sparse factorisation", 1, has_other_static, check_sparse},
      {"not cuttable", 1, is_uncut, check_uncut},
      {"all contacts", 3, [](const Scene& s) { return s.capacity == 0; }, check_all_rows},
      {"Newton's method", 2, has_newton, check_newton},
      {"longer press", 2, ends_at_rest, check_longer},
      {"worker", 3, has_work, check_worker},
      {"gravity in its place", 0.5,
       [](const Scene& s) { return s.load == "body" && s.pose == "identity" && s.regions == "one"; }, check_gravity},
      {"refused in vain", 0, has_loads_in_steps, check_refused},
      {"second servo", 1, is_alone, check_second_servo},
      {"recording", 2, [](const Scene& s) { return s.tools.size() == 1; }, check_recording},
      {"without friction", 0.5, can_slip, check_frictionless},
      {"same warning", 2, [](const Scene& s) { return is_static(s); }, check_warnings},
  };
  return all;
}

}  // namespace cross
