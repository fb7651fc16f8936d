// truth_cube: comparison of finite elements with a measured body.
//
//   truth_cube <uniaxial_positions.csv> [--out <folder>]
//
// The Truth Cube (Kerdok, Cotin, Ottensmeyer, Galea, Howe, Dawson: "Truth cube: establishing physical standards for
// soft tissue simulation", Medical Image Analysis 7, 2003, 283-291) is a cube of silicone rubber, 80 mm, with 343
// Teflon beads in it, scanned at rest and compressed by 5, 12.5 and 18.25 % between a base and a platen. The positions
// of the beads are the data of the Harvard Biorobotics Laboratory (biorobotics.harvard.edu/truthcube); they are not
// part of this project. A copy is in the repository simquest/opensurgsim,
// SurgSim/Physics/RenderTests/Data/uniaxial_positions.csv, with the parameters used here: E = 15.3 kPa, nu = 0.499, rho
// = 980 kg/m^3. E does not matter: displacements are given.
//
// Two set-ups. (a) The measured motion of the 218 outer beads is prescribed and that of the 125 inner ones predicted:
// no assumptions about base and platen are needed. (b) The whole cube, base bonded, compressed by the platen: first
// with nominal travel and no lateral motion, then with travel, lateral shift and slip of the platen fitted (four
// numbers per state, by least squares over all beads: the beads drift by up to 2 mm along y, which a straight motion of
// the platen cannot cause). Both with linear elasticity and with neo-Hookean rubber at large strain with the same
// constants. Prints tables in Markdown and writes truth_cube_shell.svg and truth_cube_platen.svg. Exit code 1: the
// locking-free element is not more accurate than an affine guess where strain is large, or a number is not finite.
#include "picture.hpp"

#include "../../benchmarks/accuracy/report.hpp"

#include <filesystem>

using namespace truth_cube;
using accuracy::Checks, accuracy::Table, accuracy::text;

namespace {

using Treated = MeanDilatation<Hex8>;

/// Distances between computed and measured beads [m].
struct Errors {
  double mean = 0.0, root_mean_square = 0.0, largest = 0.0,
         relative = 0.0;  ///< the last relative to the measured motion
};

template <class Choose>
Errors errors_of(const std::vector<Bead>& beads, const Motion& motion, std::size_t state, Choose choose) {
  Errors e;
  double count = 0.0, moved = 0.0;
  for (std::size_t b = 0; b < beads.size(); ++b) {
    if (!choose(beads[b])) continue;
    const double d = (motion[b] - beads[b].displacement[state]).norm();
    count += 1.0;
    e.mean += d;
    e.root_mean_square += d * d;
    e.largest = d <= e.largest ? e.largest : d;  // keeps NaN
    moved += beads[b].displacement[state].squaredNorm();
  }
  e.relative = std::sqrt(e.root_mean_square / moved);
  e.mean /= count;
  e.root_mean_square = std::sqrt(e.root_mean_square / count);
  return e;
}

std::string millimetres(double metres) {
  return text(1e3 * metres, "%.2f");
}

void add_row(Table& table, const std::string& name, const std::string& mesh, const std::array<Errors, 3>& errors) {
  std::vector<std::string> row{name, mesh};
  for (const Errors& e : errors)
    row.push_back(millimetres(e.mean) + " / " + millimetres(e.root_mean_square) + " / " + millimetres(e.largest) +
                  " (" + text(100.0 * e.relative, "%.1f") + " %)");
  table.add(std::move(row));
}

Table error_table() {
  return Table({"element", "cells", "5 %: mean / rms / max [mm]", "12.5 %", "18.25 %"});
}

/// Root mean square per layer, from the platen to the base.
void print_layers(const std::vector<Bead>& beads, const std::array<Motion, 3>& motion, bool inner) {
  Table table({"layer from the platen [mm]", "5 %: rms [mm]", "12.5 %", "18.25 %"});
  for (int layer = inner ? 1 : 0; layer < (inner ? per_side - 1 : per_side); ++layer) {
    std::vector<std::string> row{std::to_string(10 * (layer + 1))};
    for (std::size_t s = 0; s < 3; ++s)
      row.push_back(millimetres(errors_of(beads, motion[s], s, [&](const Bead& b) {
                                  return b.place[2] == layer && !(inner && b.outer());
                                }).root_mean_square));
    table.add(std::move(row));
  }
  table.print();
}

std::array<Errors, 3> judge(const std::vector<Bead>& beads, const std::array<Motion, 3>& motion, bool inner,
                            Checks& checks) {
  std::array<Errors, 3> errors;
  for (std::size_t s = 0; s < 3; ++s) {
    errors[s] = errors_of(beads, motion[s], s, [&](const Bead& b) { return !inner || !b.outer(); });
    checks.expect(std::isfinite(errors[s].root_mean_square), "an error is not finite");
  }
  return errors;
}

void prescribe_shell(const std::vector<Bead>& beads, const std::string& out, Checks& checks) {
  std::printf(
      "## (a) Outer beads as measured, inner beads predicted\n\nMean, root mean square and largest distance; in "
      "brackets the root mean square over that of the motion itself.\n\n");
  Table table = error_table();
  const auto each_state = [](auto make) { return std::array<Motion, 3>{make(0), make(1), make(2)}; };
  const auto affine =
      judge(beads, each_state([&](std::size_t s) { return affine_from_shell(beads, s); }), true, checks);
  add_row(table, "affine guess", "-", affine);
  const auto run = [&]<class E>(std::type_identity<E>, const char* name, int cells, auto solve) {
    const auto motion = each_state([&](std::size_t s) { return inside_measured_shell<E>(beads, s, cells, solve); });
    add_row(table, name, std::to_string(cells) + " per gap", judge(beads, motion, true, checks));
    return motion;
  };
  run(std::type_identity<Tet4>{}, "Tet4", 1, Linear{});
  run(std::type_identity<Tet4>{}, "Tet4", 2, Linear{});
  run(std::type_identity<Tet10>{}, "Tet10", 1, Linear{});
  run(std::type_identity<Tet10>{}, "Tet10, neo-Hookean", 1, AtLargeStrain{});
  run(std::type_identity<Treated>{}, "MeanDilatation<Hex8>", 1, Linear{});
  const auto best = run(std::type_identity<Treated>{}, "MeanDilatation<Hex8>", 2, Linear{});
  table.print();
  std::printf("MeanDilatation<Hex8>, per layer:\n\n");
  print_layers(beads, best, true);
  const auto treated = judge(beads, best, true, checks);
  for (const std::size_t s : {1u, 2u})
    checks.expect(treated[s].root_mean_square < affine[s].root_mean_square, "not more accurate than an affine guess");
  write_slices(out + "/truth_cube_shell.svg", beads, best, "Truth Cube, outer beads prescribed; linear, nu = 0.499");
}

void push_platen(const std::vector<Bead>& beads, const std::string& out, Checks& checks) {
  std::printf("## (b) The whole cube, base bonded, all 343 beads\n\n");
  Table straight = error_table(), fitted = error_table();
  std::string found;
  const auto run = [&]<class E>(std::type_identity<E>, const char* name, int n) {
    const auto unit = under_the_platen<E>(beads, n);
    std::array<Motion, 3> nominal, best;
    found = "Fitted with " + std::string(name) + ":";
    for (std::size_t s = 0; s < 3; ++s) {
      const PlatenMotion p = fit(beads, unit, s);
      nominal[s] = combine(unit, {nominal_travel[s], 0.0, 0.0, 0.0});
      best[s] = combine(unit, p);
      found += std::string(s == 0 ? " " : ", ") + "travel " + millimetres(p[0]) + " mm, shift (" + millimetres(p[1]) +
               ", " + millimetres(p[2]) + ") mm, widening " + text(100.0 * p[3], "%.1f") + " % at " + strains[s];
    }
    const std::string mesh = std::to_string(n) + "^3";
    add_row(straight, name, mesh, judge(beads, nominal, false, checks));
    add_row(fitted, name, mesh, judge(beads, best, false, checks));
    return best;
  };
  run(std::type_identity<Tet4>{}, "Tet4", 8);
  run(std::type_identity<Tet4>{}, "Tet4", 16);
  run(std::type_identity<Tet10>{}, "Tet10", 4);
  run(std::type_identity<Tet10>{}, "Tet10", 8);
  run(std::type_identity<Treated>{}, "MeanDilatation<Hex8>", 8);
  const auto best = run(std::type_identity<Treated>{}, "MeanDilatation<Hex8>", 16);
  for (const int n : {4, 8}) {
    std::array<Motion, 3> far;
    for (std::size_t s = 0; s < 3; ++s) far[s] = pushed_far<Tet10>(beads, n, nominal_travel[s]);
    add_row(straight, "Tet10, neo-Hookean", std::to_string(n) + "^3", judge(beads, far, false, checks));
  }
  std::printf("Platen fixed laterally, nominal travel (4, 10, 14.6 mm):\n\n");
  straight.print();
  std::printf("Travel, shift and widening of the platen side fitted:\n\n");
  fitted.print();
  std::printf("%s.\n\nPer layer, fitted, MeanDilatation<Hex8>:\n\n", found.c_str());
  print_layers(beads, best, false);
  write_slices(out + "/truth_cube_platen.svg", beads, best,
               "Truth Cube, base bonded, travel, shift and slip of the platen fitted; linear, nu = 0.499");
}

}  // namespace

int main(int argc, char** argv) try {
  if ((argc != 2 && argc != 4) || (argc == 4 && std::string(argv[2]) != "--out")) {
    std::fprintf(stderr, "truth_cube <uniaxial_positions.csv> [--out <folder>]\n");
    return 2;
  }
  const std::string out = argc == 4 ? argv[3] : ".";
  std::filesystem::create_directories(out);
  const std::vector<Bead> beads = read_beads(argv[1]);
  Checks checks;
  std::printf("# The Truth Cube, nu = 0.499, linear except where a material is named\n\n");
  prescribe_shell(beads, out, checks);
  push_platen(beads, out, checks);
  return checks.failed() == 0 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "truth_cube: %s\n", error.what());
  return 2;
}
