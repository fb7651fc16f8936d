// All load cases of a file, one after the other.
#pragma once

#include "case_file.hpp"

#include <iostream>

namespace solve_case {

struct Arguments {
  std::string case_file;
  std::filesystem::path out = ".";
  bool mesh_v41 = false;
};

inline void print(const nlohmann::ordered_json& line) {
  std::cout << line.dump() << std::endl;
}

inline void print_refusal(const std::string& name, const palpate::SetupError& error) {
  const palpate::SetupProblem& p = error.problem();
  const std::string kind(palpate::to_string(p.kind)), what = p.hint.empty() ? p.what : p.what + ". " + p.hint;
  print({{"case", name}, {"refused", {{"kind", kind}, {"what", what}}}});
}

inline std::string case_name(const json& load_case) {
  const auto name = checked("the load case", [&] { return load_case.at("name").get<std::string>(); });
  if (name.empty() || name.find_first_of("/\\") != name.npos)
    palpate::raise(SetupErrorKind::bad_file,
                   "the name of a load case becomes a file name, but '" + name + "' is not a valid one");
  return name;
}

/// Reads the mesh as one of elements E, solves every load case and prints a line for each. Every element is compiled in
/// a separate file: see tet4.cpp.
template <palpate::Element E>
void solve_all(const CaseFile& file, const Arguments& arguments);

}  // namespace solve_case
