#pragma once

#include "../../examples/solve_case/solve.hpp"

#include <palpate/io/detail/text_reader.hpp>

#include "catch.hpp"

#include <filesystem>
#include <map>

/// Comparison of linear static solutions with those of other codes (data/oracle/README.md).
namespace test {

using namespace palpate;
using solve_case::json;

inline constexpr double oracle_tolerance = 1e-6;  // of the largest value: the reference is printed with 7 digits

/// Message of a test that finds no folder with further reference results and therefore checks nothing.
inline const std::string no_further_results =
    "nothing was checked: PALPATE_ORACLE_DIR names no folder with reference results: '" PALPATE_ORACLE_DIR "'";

/// A table by node id.
using Table = std::map<Index, std::vector<double>>;

inline Table read_csv(const std::string& path) {
  std::string text = io::read_file(path);
  std::ranges::replace(text, ',', ' ');
  io::TextReader in(text, path);
  in.need_line("a header");
  Table table;
  while (in.next_line()) {
    auto& row = table[in.integer("a node id", 1, std::numeric_limits<Index>::max())];
    while (!in.rest().empty()) row.push_back(in.real("a number"));
  }
  return table;
}

/// Largest difference between columns `from` ... `from + 2` of a table and the nodal vectors of `values`, over the
/// largest reference value.
template <Element E>
double difference(const Table& reference, std::size_t from, const VectorX& values,
                  const solve_case::NumberedMesh<E>& mesh, const std::vector<NodeId>& node_map) {
  std::map<Index, Index> row_of;
  for (std::size_t i = 0; i < node_map.size(); ++i) row_of[mesh.ids.node_tags[i]] = node_map[i];
  double largest = 0.0, worst = 0.0;
  for (const auto& [id, row] : reference)
    for (std::size_t c = 0; c < 3; ++c) {
      const double value = values[3 * row_of.at(id) + static_cast<Index>(c)];
      largest = std::max(largest, std::abs(row.at(from + c)));
      worst = std::max(worst, std::isfinite(value) ? std::abs(value - row.at(from + c)) : infinity);
    }
  return worst / largest;
}

/// Compares the available results: every load case has reactions and scalars, some have displacements.
template <Element E>
void check_solution(const std::string& folder, const solve_case::NumberedMesh<E>& mesh, const json& load_case,
                    const solve_case::Solution& s) {
  const auto name = load_case.at("name").get<std::string>();
  INFO(folder << ' ' << name);
  const Table forces = read_csv(folder + '/' + name + "_reactions.csv");
  if (const std::string file = folder + '/' + name + "_u.csv"; std::filesystem::exists(file)) {
    const Table u = read_csv(file);
    CHECK(u.size() == s.node_map.size());
    CHECK(difference(u, 3, s.displacement, mesh, s.node_map) <= oracle_tolerance);
  }
  CHECK(forces.size() == s.constrained.size());
  CHECK(difference(forces, 0, s.reactions, mesh, s.node_map) <= oracle_tolerance);
  CHECK(difference(forces, 3, s.internal_force, mesh, s.node_map) <= oracle_tolerance);

  const json& scalars = load_case.at("reference").at("scalars");
  CHECK_THAT(s.strain_energy, Catch::Matchers::WithinRel(scalars.at("strain_energy").get<double>(), oracle_tolerance));
  const auto line = solve_case::summary(name, "", s);
  CHECK_THAT(line.at("max_abs_displacement").template get<double>(),
             Catch::Matchers::WithinRel(scalars.at("max_abs_displacement").get<double>(), oracle_tolerance));
  const Vector3 sum = solve_case::read_vector(line.at("sum_of_reactions")),
                expected = solve_case::read_vector(scalars.at("sum_of_reactions"));
  CHECK((sum - expected).norm() <= oracle_tolerance * s.reactions.cwiseAbs().maxCoeff());
}

template <Element E>
void check_load_case(const std::string& folder, const solve_case::NumberedMesh<E>& mesh, const json& load_case) {
  check_solution(folder, mesh, load_case, solve_case::solve<E>(mesh.mesh, load_case));
}

/// Calls check(mesh, load_case) for the load cases of a folder with this kind of analysis and returns their number; 0
/// if its elements have another name.
template <Element E, class Check>
int each_load_case(const std::string& folder, const std::string& element, std::string_view analysis, Check check) {
  const auto file = solve_case::read_case_files(folder + "/case.json").front();
  if (file.element != element) return 0;
  solve_case::NumberedMesh<E> mesh;
  mesh.mesh = io::read_mesh<E>(file.mesh_v22, 1.0, &mesh.ids);
  int checked = 0;
  for (const json& load_case : file.load_cases) {
    if (load_case.at("analysis") != analysis) continue;
    check(mesh, load_case);
    ++checked;
  }
  return checked;
}

/// Sum of check(folder) over all folders of the further reference results; -1 when they are not there.
template <class Check>
int each_reference_folder(Check check) {
  if (!std::filesystem::is_directory(PALPATE_ORACLE_DIR)) return -1;
  int checked = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(PALPATE_ORACLE_DIR))
    if (entry.path().filename() == "case.json") checked += check(entry.path().parent_path().string());
  return checked;
}

/// Checks all linear static load cases of a folder and returns how many had a reference in it.
template <Element E>
int check_folder(const std::string& folder, const std::string& element) {
  int checked = 0;
  each_load_case<E>(folder, element, solve_case::statics, [&](const auto& mesh, const json& load_case) {
    if (!std::filesystem::exists(folder + '/' + load_case.at("name").get<std::string>() + "_u.csv")) return;
    check_load_case(folder, mesh, load_case);
    ++checked;
  });
  return checked;
}

/// The same for all folders of the further reference results; -1 when they are not there.
template <Element E>
int check_all_folders(const std::string& element) {
  return each_reference_folder([&](const std::string& folder) { return check_folder<E>(folder, element); });
}

}  // namespace test
