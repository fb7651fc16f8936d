// solve_case: statics, linear or at large deformation, and natural frequencies of the load cases in a file.
//
//   solve_case CASE.json [--out DIR] [--mesh41]
//
// A case file names a Gmsh mesh in the same folder and lists load cases: a material for every region, constraints
// (boundary conditions on named groups, null means free) and loads (point forces, tractions, pressure, gravity, initial
// strain). For each of them this program
//
//   1. converts groups and conditions to a Scene, which contains names but depends on neither mesh nor element
//      (case_file.hpp),
//   2. sets up a HapticFEModel, which assembles, factorises and solves (solve.hpp),
//   3. writes DIR/<load case>_u.csv and DIR/<load case>_reactions.csv and prints one line of JSON with the largest
//      displacement, the strain energy, the sum of the reactions and the time it took.
//
// Where the analysis is "geometrically non-linear static, dead loads" it finds the equilibrium of hyperelastic bodies
// instead (large_strain.hpp). Where it is "linear eigenfrequency" it finds the lowest elastic modes instead
// (modes.hpp), writes DIR/<load case>_mode<k>_u.csv, shapes normalised by mass, and prints their frequencies; rigid
// motions of an unconstrained body are counted separately.
//
// Two kinds of files describe a time history, with a reference table from closed forms or another code: a cube that
// relaxes, creeps or oscillates, and a bar under a suddenly applied tension (in_time.hpp). The history is written to
// DIR/<load case>.csv, and the printed line contains the difference from the table.
//
// Everything that palpate does not support (another material law, another element, a group that the mesh does not have)
// is refused by name in that line, and the next load case is tried: a wrong result is never printed. The exit code is 0
// when every load case was solved or refused, and 2 when the case file or its mesh cannot be read.
#include "solve_all.hpp"

using namespace solve_case;

namespace {

void refuse_all(const CaseFile& file, const Arguments&) {
  const auto refuse = [](const std::string& name, std::string what, std::string hint) {
    print_refusal(name, palpate::SetupError({SetupErrorKind::unsupported, std::move(what), std::move(hint), {}}));
  };
  for (const json& load_case : file.load_cases)
    refuse(case_name(load_case), "the element '" + file.element + "'", "palpate has tet4, tet10, hex8 and hex20");
  if (file.load_cases.empty()) refuse(file.title, "a case file without known load cases", {});
}

/// A new element is one line here and a source file like tet4.cpp.
constexpr std::pair<std::string_view, void (*)(const CaseFile&, const Arguments&)> elements[] = {
    {"tet4", solve_all<palpate::Tet4>},
    {"tet10", solve_all<palpate::Tet10>},
    {"hex8", solve_all<palpate::Hex8>},
    {"hex20", solve_all<palpate::Hex20>},
};

Arguments read_arguments(int argc, char** argv) {
  Arguments arguments;
  for (int i = 1; i < argc; ++i) {
    const std::string word = argv[i];
    if (word == "--out" && i + 1 < argc)
      arguments.out = argv[++i];
    else if (word == "--mesh41")
      arguments.mesh_v41 = true;
    else if (arguments.case_file.empty() && !word.starts_with("-"))
      arguments.case_file = word;
    else
      palpate::raise(SetupErrorKind::bad_argument, "'" + word + "' is not understood",
                     "solve_case CASE.json [--out DIR] [--mesh41]");
  }
  if (arguments.case_file.empty())
    palpate::raise(SetupErrorKind::bad_argument, "no case file was given",
                   "solve_case CASE.json [--out DIR] [--mesh41]");
  return arguments;
}

}  // namespace

int main(int argc, char** argv) try {
  const Arguments arguments = read_arguments(argc, argv);
  std::filesystem::create_directories(arguments.out);
  for (const CaseFile& file : read_case_files(arguments.case_file)) {
    const auto element = std::ranges::find(elements, file.element, [](const auto& e) { return e.first; });
    const auto run = element != std::end(elements) ? element->second : refuse_all;
    run(file, arguments);
  }
  return 0;
} catch (const std::exception& error) {
  std::cerr << "solve_case: " << error.what() << '\n';
  return 2;
}
