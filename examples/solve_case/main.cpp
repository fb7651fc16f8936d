// solve_case: linear static analysis of the load cases in a file.
//
//   solve_case CASE.json [--out DIR] [--mesh41]
//
// A case file names a Gmsh mesh that lies beside it and lists load cases: a material for every region, what is held
// (boundary conditions on named groups, null means free) and what loads the body (point forces, tractions, pressure,
// gravity, initial strain). For each of them this program
//
//   1. turns groups and conditions into a Scene, which knows names but neither mesh nor element (case_file.hpp),
//   2. sets up a HapticFEModel, which assembles, factorises and solves (solve.hpp),
//   3. writes DIR/<load case>_u.csv and DIR/<load case>_reactions.csv and prints one line of JSON with the largest
//      displacement, the strain energy, the sum of the reactions and the time it took.
//
// Whatever palpate does not do (a non-linear material, an eigenvalue problem, an element it lacks, a group that the
// mesh does not have) is refused by name in that line, and the next load case is tried: a wrong answer is never
// printed. The exit code is 0 when every load case was solved or refused, and 2 when the case file or its mesh cannot
// be read.
#include "solve.hpp"

#include <iostream>

using namespace solve_case;

namespace {

struct Arguments {
  std::string case_file;
  std::filesystem::path out = ".";
  bool mesh_v41 = false;
};

void print(const nlohmann::ordered_json& line) { std::cout << line.dump() << std::endl; }

void print_refusal(const std::string& name, const palpate::SetupError& error) {
  const palpate::SetupProblem& p = error.problem();
  const std::string kind(palpate::to_string(p.kind)), what = p.hint.empty() ? p.what : p.what + ". " + p.hint;
  print({{"case", name}, {"refused", {{"kind", kind}, {"what", what}}}});
}

std::string case_name(const json& load_case) {
  const auto name = checked("the load case", [&] { return load_case.at("name").get<std::string>(); });
  if (name.empty() || name.find_first_of("/\\") != name.npos)
    palpate::raise(SetupErrorKind::bad_file, "the name of a load case becomes a file name; '" + name + "' is none");
  return name;
}

template <palpate::Element E>
void solve_load_case(const NumberedMesh<E>& numbered, const std::string& element, const json& load_case,
                     const std::filesystem::path& out) {
  const std::string name = case_name(load_case);
  try {
    const Solution solution = checked(name, [&] { return solve<E>(numbered.mesh, load_case); });
    write_csv(out, name, numbered, solution);
    print(summary(name, element, solution));
  } catch (const palpate::SetupError& error) {
    print_refusal(name, error);
  }
}

template <palpate::Element E>
void solve_all(const CaseFile& file, const Arguments& arguments) {
  NumberedMesh<E> numbered;
  const bool use_v41 = arguments.mesh_v41 || !std::filesystem::exists(file.mesh_v22);
  try {
    numbered.mesh = palpate::io::read_mesh<E>(use_v41 ? file.mesh_v41 : file.mesh_v22, 1.0, &numbered.ids);
  } catch (const palpate::SetupError& error) {
    if (error.kind() != SetupErrorKind::unsupported) throw;
    for (const json& load_case : file.load_cases) print_refusal(case_name(load_case), error);
    return;
  }
  for (const json& load_case : file.load_cases) solve_load_case(numbered, file.element, load_case, arguments.out);
}

void refuse_all(const CaseFile& file, const Arguments&) {
  const auto refuse = [](const std::string& name, std::string what, std::string hint) {
    print_refusal(name, palpate::SetupError({SetupErrorKind::unsupported, std::move(what), std::move(hint), {}}));
  };
  for (const json& load_case : file.load_cases)
    refuse(case_name(load_case), "the element '" + file.element + "'", "palpate has tet4");
  if (file.load_cases.empty()) refuse(file.title, "a case file without load_cases", {});
}

/// A new element is one line here, beside its GmshElement.
constexpr std::pair<std::string_view, void (*)(const CaseFile&, const Arguments&)> elements[] = {
    {"tet4", solve_all<palpate::Tet4>},
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
  const CaseFile file = read_case_file(arguments.case_file);
  std::filesystem::create_directories(arguments.out);
  const auto element = std::ranges::find(elements, file.element, [](const auto& e) { return e.first; });
  const auto run = element != std::end(elements) ? element->second : refuse_all;
  run(file, arguments);
  return 0;
} catch (const std::exception& error) {
  std::cerr << "solve_case: " << error.what() << '\n';
  return 2;
}
