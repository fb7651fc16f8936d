// Convergence on a manufactured solution.
#include "manufactured.hpp"

#include "../common/markup.hpp"
#include "elements.hpp"
#include "order_plot.hpp"
#include "parts.hpp"

#include <fstream>

namespace accuracy {

namespace {

/// All refinements of one element.
template <Element E>
void refine(bool distorted, const std::string& colour, Table& table, OrderPlot& displacement, OrderPlot& energy,
            Checks& checks) {
  const Manufactured field;
  const auto [expected_u, expected_e] = theoretical_orders<E>(distorted);
  const std::string name = element_name<E>(), kind = distorted ? "distorted" : "even";
  std::vector<std::array<double, 2>> curve_u, curve_e;
  Errors before;
  int coarse = 0;
  double order_u = 0.0, order_e = 0.0;
  for (const int n : E::order == 1 ? std::array{4, 8, 16} : std::array{2, 4, 8}) {
    const Errors now = manufactured_errors(refined_cube<E>(n, distorted), field, &solve<E>);
    std::string shown_u = "-", shown_e = "-";
    if (coarse > 0) {
      order_u = observed_order(before.displacement, now.displacement, double(n) / coarse);
      order_e = observed_order(before.energy, now.energy, double(n) / coarse);
      shown_u = text(order_u, "%.2f");
      shown_e = text(order_e, "%.2f");
    }
    table.add({name, kind, std::to_string(n), text(now.displacement), shown_u, text(expected_u), text(now.energy),
               shown_e, text(expected_e)});
    curve_u.push_back({double(n), now.displacement});
    curve_e.push_back({double(n), now.energy});
    before = now;
    coarse = n;
  }
  checks.expect(order_u > expected_u - 0.2, name + " " + kind + ": displacement of order " + text(order_u));
  checks.expect(order_e > expected_e - 0.1, name + " " + kind + ": energy of order " + text(order_e));
  checks.expect(before.displacement < 0.05, name + " " + kind + ": the displacement does not converge to the solution");
  displacement.add(bench::escaped(name) + (distorted ? ", distorted" : ""), colour, distorted, std::move(curve_u));
  energy.add(bench::escaped(name) + (distorted ? ", distorted" : ""), colour, distorted, std::move(curve_e));
}

}  // namespace

void manufactured_solution(const std::string& picture, Checks& checks) {
  std::printf(
      "## Manufactured solution\n\nA unit cube, nu = 0.3, trigonometric displacement. Relative errors; n cells "
      "along an edge (six tetrahedra in each); distorted: inner corners moved by up to 0.1 / n.\n\n");
  Table table({"element", "mesh", "n", "error of u (L2)", "order", "theory", "error in energy", "order", "theory"});
  OrderPlot displacement(0, "Relative error of displacement (L2)"), energy(420, "Relative error in the energy norm");
  constexpr std::array colours{"#c53030", "#2b6cb0", "#d69e2e", "#2f855a", "#6b46c1", "#0d9488", "#b83280", "#4a5568"};
  std::size_t next = 0;
  each_element([&]<class E>(std::type_identity<E>) {
    const std::string colour = colours[next++ % colours.size()];
    for (const bool distorted : {false, true}) refine<E>(distorted, colour, table, displacement, energy, checks);
  });
  table.print();
  std::ofstream(picture) << "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 820 570' width='820' height='570'>\n"
                         << "<rect width='820' height='570' fill='white'/>\n"
                         << displacement.svg() << energy.svg() << "</svg>\n";
  std::printf("Picture: %s\n\n", picture.c_str());
}

}  // namespace accuracy
