// Defines solve_all for the source files that instantiate it, one per element.
#pragma once

#include "in_time.hpp"
#include "large_strain.hpp"
#include "modes.hpp"
#include "solve_all.hpp"

namespace solve_case {

template <palpate::Element E>
void solve_load_case(const NumberedMesh<E>& numbered, const std::string& element, const json& load_case,
                     const std::filesystem::path& out) {
  const std::string name = case_name(load_case);
  const auto run = [&](auto solver) {
    const auto solution = checked(name, [&] { return solver(numbered.mesh, load_case); });
    write_csv(out, name, numbered, solution);
    print(summary(name, element, solution));
  };
  try {
    const auto analysis = load_case.value("analysis", "");
    if (analysis == eigenfrequencies)
      run(solve_modes<E>);
    else if (analysis == large_strain_statics)
      run(solve_large_strain<E>);
    else if (analysis == cube_in_time)
      run(solve_cube_in_time<E>);
    else if (analysis == bar_in_time)
      run(solve_bar_in_time<E>);
    else
      run(solve<E>);
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

}  // namespace solve_case
