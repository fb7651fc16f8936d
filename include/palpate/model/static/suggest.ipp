// Definitions of suggest.hpp.
#pragma once

#include <palpate/model/static/suggest.hpp>

#include <palpate/core/setup_error.hpp>
#include <palpate/model/static/detail/candidate_maker.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <utility>

namespace palpate { inline namespace PALPATE_ABI {

namespace detail {

/// With two significant digits.
inline std::string rounded(double value, const char* unit) {
  if (!(value > 0.0)) return std::string("0 ") + unit;
  const double step = std::pow(10.0, std::floor(std::log10(value)) - 1.0);
  return number(std::round(value / step) * step) + ' ' + unit;
}

inline std::string percent_text(double part) {
  return rounded(100.0 * part, "%");
}

/// What a candidate exceeds; empty: nothing.
inline std::string excess(const SuggestedModel& model, const SuggestBudget& budget) {
  if (model.tick > budget.tick_seconds)
    return "a tick takes " + rounded(1e6 * model.tick, "us") + ", more than " +
           rounded(1e6 * budget.tick_seconds, "us");
  if (model.setup > budget.setup_seconds)
    return "the set-up takes " + rounded(model.setup, "s") + ", more than " + rounded(budget.setup_seconds, "s");
  return {};
}

/// The best of the candidates that `allowed` admits; -1: none.
template <class Allowed, class Order>
std::optional<std::size_t> best_of(const std::vector<SuggestedModel>& models, Allowed allowed, Order order) {
  std::optional<std::size_t> best;
  for (std::size_t i = 0; i < models.size(); ++i)
    if (allowed(models[i]) && (!best || order(models[i]) < order(models[*best]))) best = i;
  return best;
}

/// Chooses among the measured candidates.
inline void choose(Suggestion& s, const SuggestBudget& budget) {
  const auto fits = [&](const SuggestedModel& m) { return m.measured && excess(m, budget).empty(); };
  if (budget.error > 0.0)
    s.chosen = best_of(
        s.candidates, [&](const SuggestedModel& m) { return fits(m) && m.largest <= budget.error; },
        [](const SuggestedModel& m) { return m.setup; });
  s.within_error = s.chosen.has_value();
  if (!s.chosen) s.chosen = best_of(s.candidates, fits, [](const SuggestedModel& m) { return m.largest; });
  if (budget.error == 0.0) s.within_error = s.chosen.has_value();
  for (SuggestedModel& m : s.candidates)
    if (m.measured) m.remark = excess(m, budget);
}

inline std::string reason_for(const Suggestion& s, const SuggestBudget& budget) {
  if (!s.chosen) {
    const auto fastest = best_of(
        s.candidates, [](const SuggestedModel& m) { return m.measured; },
        [&](const SuggestedModel& m) {
          return std::max(m.tick / budget.tick_seconds, m.setup / budget.setup_seconds);
        });
    if (!fastest) return "nothing could be measured: " + s.candidates.front().remark;
    const SuggestedModel& m = s.candidates[*fastest];
    return "nothing is within the budget; nearest is " + m.name() + ": " + m.remark;
  }
  const SuggestedModel& m = s.candidates[*s.chosen];
  const std::string what = m.name() + ", with errors of at most " + percent_text(m.largest) + ", a tick of " +
                           rounded(1e6 * m.tick, "us") + " and a set-up of " + rounded(m.setup, "s");
  if (budget.error == 0.0) return "most accurate within the budget: " + what;
  return s.within_error ? "shortest set-up with an error of at most " + percent_text(budget.error) + ": " + what
                        : "none has an error of at most " + percent_text(budget.error) +
                              " within the budget; most accurate is " + what;
}

PALPATE_INLINE std::string SuggestedModel::name() const {
  return element +
         (edge > 0.0 ? " on the mesh refined to edges of " + rounded(1e3 * edge, "mm") : " on the mesh as given");
}

}  // namespace detail

PALPATE_INLINE std::string Suggestion::code() const {
  if (!chosen) return "// " + reason + "\n";
  const detail::SuggestedModel& m = candidates[*chosen];
  std::string mesh = m.edge > 0.0 ? "refine_near_touched(mesh, scene, " + number(m.edge) + ")" : "mesh";
  if (m.element == "Tet10") mesh = "promote<Tet10>(" + mesh + ")";
  return "// " + reason + "\nusing Model = HapticFEModel<" + m.element +
         ", LinearElastic, Condensed<SelectiveInverse>>;\n" +
         (lists_nodes && (m.edge > 0.0 || m.element == "Tet10") ? "scene = name_listed_nodes(mesh, scene);\n" : "") +
         "Model model(" + mesh + ", scene, material);\n";
}

PALPATE_INLINE Suggestion suggest(const Mesh<Tet4>& mesh, const Scene& scene,
                                  const RegionMaterials<LinearElastic>& materials,
                                  const detail::SuggestBudget& budget) {
  detail::SuggestedModelMaker maker(mesh, scene, materials, budget);
  Suggestion s;
  s.lists_nodes = detail::lists_nodes(scene);
  s.candidates = maker.make_all();
  detail::choose(s, budget);
  s.reason = detail::reason_for(s, budget);
  s.seconds = maker.seconds();
  return s;
}

PALPATE_INLINE Suggestion suggest(const Mesh<Tet4>& mesh, const Scene& scene, const LinearElastic& material,
                                  const detail::SuggestBudget& budget) {
  return suggest(mesh, scene, RegionMaterials<LinearElastic>{{everywhere, material}}, budget);
}

}}  // namespace palpate
