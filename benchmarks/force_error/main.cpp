#include <palpate/element/wrappers.hpp>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "table.hpp"

namespace force_error { namespace {

/// What a run covers.
struct Choice {
  std::vector<std::string> bodies;  ///< empty: all
  std::vector<double> poisson_ratios{0.3, 0.45, 0.49, 0.4999};
  std::vector<double> radii{0.2, 0.5, 1.0, 2.0, 5.0, 10.0};  ///< in facets
  bool cells = true, tick_cost = true;
};

/// --quick: one Poisson ratio and three radii. --body NAME, --poisson NU, --radius R repeated: only these.
/// --no-ticks: without the cost of a tick; --ticks: only that.
Choice choice_of(int argc, char** argv) {
  Choice choice;
  std::vector<double> poisson_ratios, radii;
  for (int i = 1; i < argc; ++i) {
    const std::string option = argv[i];
    if (option == "--quick") {
      choice.poisson_ratios = {0.45};
      choice.radii = {0.5, 1.5, 4.0};
    } else if (option == "--no-ticks") {
      choice.tick_cost = false;
    } else if (option == "--ticks") {
      choice.cells = false;
    } else if (i + 1 < argc && option == "--body") {
      choice.bodies.emplace_back(argv[++i]);
    } else if (i + 1 < argc && (option == "--poisson" || option == "--radius")) {
      (option == "--poisson" ? poisson_ratios : radii).push_back(std::atof(argv[++i]));
    } else {
      std::fprintf(stderr,
                   "bench_force_error [--quick] [--body NAME]... [--poisson NU]... [--radius FACETS]... "
                   "[--no-ticks | --ticks]\n");
      std::exit(2);
    }
  }
  if (!poisson_ratios.empty()) choice.poisson_ratios = poisson_ratios;
  if (!radii.empty()) choice.radii = radii;
  return choice;
}

/// Tools of up to two facets press the mesh as given; for larger ones it is refined at the places. Capsule and plate
/// press two places for two of the radii. The error is measured for one Poisson ratio.
void add_cells(Table& table, const TestBody& body, double poisson_ratio, double per_facet) {
  const double given = mean_facet(body), radius = std::min(per_facet, 2.0) * given;
  const bool all_tools = per_facet == 0.5 || per_facet == 2.0;
  Case test{body, poisson_ratio, radius, std::min(given, radius / per_facet), {}, all_tools};
  test.places = places_on(body, radius, std::min(1.5 * given + 0.5 * radius, 0.02), 7, all_tools ? 2 : 4);
  const Presses exact = truth(test);
  const bool measure = poisson_ratio == 0.45;
  const auto add = [&](const char* element, const Answer& a) { table.add(test, per_facet, element, exact, a); };
  add("Smoothed", answer<Smoothed<Tet4>>(test, measure));
  add("Tet4", answer<Tet4>(test, measure));
  if (per_facet < 10.0) add("Tet10", answer<Tet10>(test, measure));  // as fine as the truth
  if (!body.hexahedra || per_facet > 5.0) return;                    // a hundred thousand hexahedra
  add("Hex8", answer<Hex8>(test, measure));
  add("MeanDil", answer<MeanDilatation<Hex8>>(test, measure));
}

}  // namespace
}  // namespace force_error

int main(int argc, char** argv) {
  using namespace force_error;
  const Choice choice = choice_of(argc, argv);
  if (!choice.cells) {
    print_tick_cost();
    return 0;
  }
  const std::vector<TestBody> bodies = test_bodies();
  const TestBody& block =
      *std::find_if(bodies.begin(), bodies.end(), [](const TestBody& b) { return b.name == "block"; });
  for (const double poisson_ratio : choice.poisson_ratios) {
    const double radius = mean_facet(block);
    print_truth_error({block, poisson_ratio, radius, radius, places_on(block, radius, 2.0 * radius, 7, 2), true});
  }
  Table table;
  for (const TestBody& body : bodies) {
    if (!choice.bodies.empty() && std::count(choice.bodies.begin(), choice.bodies.end(), body.name) == 0) continue;
    for (const double poisson_ratio : choice.poisson_ratios)
      for (const double per_facet : choice.radii) add_cells(table, body, poisson_ratio, per_facet);
  }
  table.print();
  if (choice.tick_cost) print_tick_cost();
  std::printf("%s\n", table.is_good() ? "pass" : "FAIL");
  return table.is_good() ? 0 : 1;
}
