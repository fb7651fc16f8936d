#include "composition_lists.hpp"

#include <algorithm>

namespace cross {

namespace {

/// Whether a word is one of some.
template <class... Words>
bool is_one_of(const std::string& word, Words... some) {
  return ((word == some) || ...);
}

}  // namespace

const std::vector<Composition>& compositions() {
  static const Compositions all = [] {
    Compositions made;
    for (const auto add :
         {add_static, add_stiffening, add_moving_tet4, add_moving_smoothed, add_moving_tet10, add_moving_hex8,
          add_moving_hex20, add_cut, add_cut_moving_tetrahedra, add_cut_moving_hexahedra})
      add(made);
    return made;
  }();
  return all;
}

const Composition* find_composition(const std::string& element, const std::string& law, const std::string& solver) {
  const std::vector<Composition>& all = compositions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Composition& c) {
    return c.element == element && c.law == law && c.solver == solver;
  });
  return found == all.end() ? nullptr : &*found;
}

bool moves(const std::string& solver) {
  return is_one_of(solver, "newton", "corotated_cg", "quasi_newton", "quasi_newton_float", "central_difference",
                   "semi_implicit_euler", "cut_quasi_newton", "cut_quasi_newton_float");
}

bool can_be_cut(const std::string& solver) {
  return solver.starts_with("cut_");
}

bool has_float(const std::string& solver) {
  return solver.ends_with("_float") || solver == "corotated_cg";
}

}  // namespace cross
