// Linear static solutions against those of other codes: CalculiX for the fields, GetFEM for the scalars
// (data/oracle/README.md).
#if __has_include(<nlohmann/json.hpp>)

#include "../../examples/solve_case/solve.hpp"

#include "catch.hpp"

#include <map>

using namespace palpate;
using solve_case::json;

namespace {

constexpr double tolerance = 1e-6;  // of the largest value: the reference is printed with 7 digits

/// A table by node id.
using Table = std::map<Index, std::vector<double>>;

Table read_csv(const std::string& path) {
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
double difference(const Table& reference, std::size_t from, const VectorX& values,
                  const solve_case::NumberedMesh<Tet4>& mesh, const std::vector<NodeId>& node_map) {
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

void check_load_case(const std::string& folder, const solve_case::NumberedMesh<Tet4>& mesh, const json& load_case) {
  const auto name = load_case.at("name").get<std::string>();
  INFO(folder << ' ' << name);
  const auto s = solve_case::solve<Tet4>(mesh.mesh, load_case);
  const Table u = read_csv(folder + '/' + name + "_u.csv"), forces = read_csv(folder + '/' + name + "_reactions.csv");
  CHECK(u.size() == s.node_map.size());
  CHECK(difference(u, 3, s.displacement, mesh, s.node_map) <= tolerance);
  CHECK(forces.size() == s.held.size());
  CHECK(difference(forces, 0, s.reactions, mesh, s.node_map) <= tolerance);
  CHECK(difference(forces, 3, s.internal_force, mesh, s.node_map) <= tolerance);

  const json& scalars = load_case.at("reference").at("scalars");
  CHECK_THAT(s.strain_energy, Catch::Matchers::WithinRel(scalars.at("strain_energy").get<double>(), tolerance));
  const auto line = solve_case::summary(name, "tet4", s);
  CHECK_THAT(line.at("max_abs_displacement").get<double>(),
             Catch::Matchers::WithinRel(scalars.at("max_abs_displacement").get<double>(), tolerance));
  const Vector3 sum = solve_case::read_vector(line.at("sum_of_reactions")),
                expected = solve_case::read_vector(scalars.at("sum_of_reactions"));
  CHECK((sum - expected).norm() <= tolerance * s.reactions.cwiseAbs().maxCoeff());
}

/// Checks all linear static load cases of a folder that have a reference in it, and returns how many these are.
int check_folder(const std::string& folder) {
  const auto file = solve_case::read_case_file(folder + "/case.json");
  if (file.element != "tet4") return 0;
  solve_case::NumberedMesh<Tet4> mesh;
  mesh.mesh = io::read_mesh<Tet4>(file.mesh_v22, 1.0, &mesh.ids);
  int checked = 0;
  for (const json& load_case : file.load_cases) {
    if (load_case.at("analysis") != "linear static, small strain") continue;
    if (!std::filesystem::exists(folder + '/' + load_case.at("name").get<std::string>() + "_u.csv")) continue;
    check_load_case(folder, mesh, load_case);
    ++checked;
  }
  return checked;
}

SetupErrorKind refusal(const json& load_case) {
  const auto mesh = io::read_mesh<Tet4>(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/mesh_v22.msh");
  try {
    solve_case::checked("case", [&] { return solve_case::solve<Tet4>(mesh, load_case); });
  } catch (const SetupError& error) {
    return error.kind();
  }
  FAIL("accepted");
  return {};
}

}  // namespace

TEST_CASE("Linear statics agrees with the reference results in the tree", "[oracle]") {
  CHECK(check_folder(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4") == 10);
  CHECK(check_folder(PALPATE_TEST_DATA "/oracle/J_organ/tet4_2k") == 4);
}

TEST_CASE("Linear statics agrees with all further reference results", "[oracle]") {
  if (!std::filesystem::is_directory(PALPATE_ORACLE_DIR)) {
    WARN("skipped: there is no folder " PALPATE_ORACLE_DIR);
    return;
  }
  int checked = 0;
  for (const auto& entry : std::filesystem::recursive_directory_iterator(PALPATE_ORACLE_DIR))
    if (entry.path().filename() == "case.json") checked += check_folder(entry.path().parent_path().string());
  CHECK(checked > 0);
}

TEST_CASE("A load case that says something unknown is refused", "[oracle]") {
  const auto file = solve_case::read_case_file(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/case.json");
  const json good = file.load_cases.front();
  const auto with = [&](const char* pointer, const json& value) {
    json changed = good;
    changed[json::json_pointer(pointer)] = value;
    return refusal(changed);
  };
  CHECK(with("/analysis", "linear eigenfrequency") == SetupErrorKind::unsupported);
  CHECK(with("/damping", 0.1) == SetupErrorKind::unsupported);
  CHECK(with("/materials/cube_a/model", "neo_hooke_iso") == SetupErrorKind::unsupported);
  CHECK(with("/materials/cube_a/tau", 0.5) == SetupErrorKind::unsupported);
  CHECK(with("/materials/cube_a/nu", 0.5) == SetupErrorKind::bad_poisson_ratio);
  CHECK(with("/materials/cube_a/E", "soft") == SetupErrorKind::bad_file);
  CHECK(with("/materials/cube_c", good.at("materials").at("cube_a")) == SetupErrorKind::unknown_group);
  CHECK(with("/loads/0/type", "torque") == SetupErrorKind::unsupported);
  CHECK(with("/loads/0/follower", true) == SetupErrorKind::unsupported);
  CHECK(with("/loads/0/group", "nowhere") == SetupErrorKind::unknown_group);
  CHECK(with("/loads/0/force", {1.0, 2.0}) == SetupErrorKind::bad_file);
  CHECK(with("/loads/0", {{"type", "initial_strain"}, {"eps0", "alpha_T*I"}}) == SetupErrorKind::bad_file);
  CHECK(with("/boundary_conditions/0/group", "nowhere") == SetupErrorKind::unknown_group);
  CHECK(with("/boundary_conditions/0/group", "boundary_nodes_at_w=0") == SetupErrorKind::unknown_group);
  CHECK(with("/boundary_conditions/0/group", "boundary_nodes_at_x=7") == SetupErrorKind::empty_group);
  CHECK(with("/boundary_conditions/0/u", {nullptr, nullptr, nullptr}) == SetupErrorKind::unconstrained);

  json by_coordinate = good;
  by_coordinate["boundary_conditions"][0]["group"] = "boundary_nodes_at_x=0";  // the same nodes as group "fixed"
  const auto mesh = io::read_mesh<Tet4>(file.mesh_v22);
  CHECK(solve_case::solve<Tet4>(mesh, by_coordinate).displacement == solve_case::solve<Tet4>(mesh, good).displacement);
}

#endif
