// Natural frequencies of one load case with elements E.
#pragma once

#include <palpate/model/static/natural_frequencies.hpp>

#include <chrono>

#include "solve.hpp"

namespace solve_case {

/// The modes of a load case; `node_map` as in Solution.
struct Modes {
  palpate::NaturalFrequencies found;
  std::vector<palpate::NodeId> node_map;
  double seconds = 0.0;
};

/// Finds the lowest elastic modes, eight unless the load case has "modes": n. A body that is not fully constrained has
/// rigid motions. Throws SetupError.
template <palpate::Element E>
Modes solve_modes(const palpate::Mesh<E>& mesh, const json& load_case) {
  check_analysis(load_case, eigenfrequencies);
  const palpate::Scene scene = read_supports(load_case, mesh);
  const Materials materials = read_materials(load_case);
  const int count = load_case.value("modes", 8);

  const auto start = std::chrono::steady_clock::now();
  palpate::Admitted<E> admitted = palpate::admit<E>(mesh);
  const auto body = palpate::make_body(std::move(admitted.mesh), materials);
  Modes modes{
      palpate::natural_frequencies(body, scene.mapped(admitted.node_map, palpate::Vector3::Zero()), count), {}, 0.0};
  modes.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  modes.node_map = std::move(admitted.node_map);
  return modes;
}

/// Writes <name>_mode<k>_u.csv, k from 1.
template <palpate::Element E>
void write_csv(const std::filesystem::path& folder, const std::string& name, const NumberedMesh<E>& numbered,
               const Modes& modes) {
  for (palpate::Index k = 0; k < modes.found.shapes.cols(); ++k)
    write_nodes(folder / (name + "_mode" + std::to_string(k + 1) + "_u.csv"), numbered, modes.node_map,
                modes.found.shapes.col(k));
}

/// The line printed for the modes of a load case.
inline nlohmann::ordered_json summary(const std::string& name, const std::string& element, const Modes& modes) {
  const palpate::VectorX& f = modes.found.frequencies;
  return {{"case", name},
          {"element", element},
          {"frequencies_hz", std::vector<double>(f.begin(), f.end())},
          {"rigid_modes", modes.found.rigid_modes()},
          {"largest_residual", modes.found.residuals.maxCoeff()},
          {"seconds", modes.seconds}};
}

}  // namespace solve_case
