// Static equilibrium at large deformation against CalculiX (fields), GetFEM (scalars) and closed forms
// (data/oracle/README.md).
#include "../../examples/solve_case/large_strain.hpp"
#include "properties/oracle_checks.hpp"

using namespace palpate;
using solve_case::json;

namespace {

/// Checks the load cases at large strain of a folder and returns how many there are with reference files.
template <Element E>
int check_large_strain(const std::string& folder, const std::string& element) {
  int checked = 0;
  test::each_load_case<E>(folder, element, solve_case::large_strain_statics, [&](const auto& mesh, const json& c) {
    if (!std::filesystem::exists(folder + '/' + c.at("name").get<std::string>() + "_reactions.csv")) return;
    const auto s = solve_case::solve_large_strain<E>(mesh.mesh, c);
    test::check_solution(folder, mesh, c, s);
    ++checked;
    if (!c.contains("closed_form") || !c.at("closed_form").contains("axial_force")) return;
    INFO(c.at("name"));
    double axial = 0.0;  // on the face that is pulled, of a cube of side 1
    for (const NodeId i : s.constrained)
      if (mesh.mesh.position(i)[0] > 0.5) axial += s.reactions[3 * Index{s.node_map[static_cast<std::size_t>(i)]}];
    CHECK_THAT(axial, Catch::Matchers::WithinRel(c.at("closed_form").at("axial_force").template get<double>(), 1e-9));
    CHECK_THAT(s.strain_energy,
               Catch::Matchers::WithinRel(c.at("closed_form").at("energy").template get<double>(), 1e-9));
  });
  return checked;
}

}  // namespace

TEST_CASE("Equilibrium at large strain agrees with the reference results in the tree", "[oracle][large_strain]") {
  const std::string folder = PALPATE_TEST_DATA "/oracle";
  CHECK(check_large_strain<Hex8>(folder + "/G_hyperelastic_cube/hex8", "hex8") == 18);
  CHECK(check_large_strain<Tet10>(folder + "/G_hyperelastic_cube/tet10", "tet10") == 2);
  CHECK(check_large_strain<Tet4>(folder + "/J_organ/tet4_2k", "tet4") == 2);
}

TEST_CASE("Equilibrium at large strain agrees with all further reference results", "[oracle][large_strain]") {
  const int checked = test::each_reference_folder([](const std::string& folder) {
    return check_large_strain<Tet4>(folder, "tet4") + check_large_strain<Tet10>(folder, "tet10") +
           check_large_strain<Hex8>(folder, "hex8");
  });
  if (checked < 0) WARN(test::no_further_results);
  CHECK(checked != 0);
}

TEST_CASE("A load case at large strain with unknown content is refused", "[oracle][large_strain]") {
  const std::string folder = PALPATE_TEST_DATA "/oracle/G_hyperelastic_cube/hex8";
  const auto file = solve_case::read_case_files(folder + "/case.json").front();
  const auto mesh = io::read_mesh<Hex8>(file.mesh_v22);
  const auto refusal = [&](const char* pointer, const json& value) {
    json changed = file.load_cases.front();
    changed[json::json_pointer(pointer)] = value;
    try {
      solve_case::checked("case", [&] { return solve_case::solve_large_strain<Hex8>(mesh, changed); });
    } catch (const SetupError& error) {
      return error.kind();
    }
    FAIL("accepted");
    return SetupErrorKind{};
  };
  CHECK(refusal("/materials/cube/model", "ogden") == SetupErrorKind::unsupported);
  CHECK(refusal("/materials/cube/tau", 0.5) == SetupErrorKind::unsupported);
  CHECK(refusal("/materials/cube/nu", 0.5) == SetupErrorKind::bad_poisson_ratio);
  CHECK(refusal("/analysis", "linear static, small strain") == SetupErrorKind::unsupported);
  CHECK(refusal("/boundary_conditions/3/u", {-1.0, nullptr, nullptr}) == SetupErrorKind::not_converged);
}
