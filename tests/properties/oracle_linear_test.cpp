// Linear static solutions against those of other codes: CalculiX for the fields, GetFEM for the scalars
// (data/oracle/README.md).
#include "properties/oracle_checks.hpp"

using namespace palpate;
using solve_case::json;
using test::check_folder;

namespace {

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
  CHECK(check_folder<Tet4>(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4", "tet4") == 10);
  CHECK(check_folder<Tet4>(PALPATE_TEST_DATA "/oracle/J_organ/tet4_2k", "tet4") == 4);
}

TEST_CASE("Linear statics agrees with all further reference results", "[oracle]") {
  const int checked = test::check_all_folders<Tet4>("tet4");
  if (checked < 0) WARN(test::no_further_results);
  CHECK(checked != 0);
}

TEST_CASE("A load case with unknown content is refused", "[oracle]") {
  const auto file = solve_case::read_case_files(PALPATE_TEST_DATA "/oracle/A_two_cubes/tet4/case.json").front();
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
